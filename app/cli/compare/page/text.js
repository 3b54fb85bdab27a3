// The methods of the report: their names and colours.

const scale = dataOf('scale'); // colours of the error maps, least to largest error
const methods = Array.isArray(report.methods) ? report.methods : [];

// "lpv:dim=32+vo" → ["lpv", "vo"]; a plus before a digit belongs to a number (1e+05).
const terms = gi => String(gi ?? '').split(/\+(?!\d)/);
const techniquesOf = method => terms(method.gi).map(term => term.split(':')[0]);

// {"lpv.dim": "32", …}
function optionsOf(method) {
  const flat = {};
  for (const [technique, options] of Object.entries(method.options ?? {}))
    for (const [option, value] of Object.entries(options ?? {}))
      flat[`${technique}.${option}`] = isNumber(value) ? String(+value.toPrecision(6)) : String(value);
  return flat;
}

// The GI spec with all options, as --gi accepts it.
function specOf(method) {
  return terms(method.gi).map(term => {
    const name = term.split(':')[0];
    const options = Object.entries(method.options?.[name] ?? {}).map(([option, value]) => `${option}=${value}`);
    return options.length ? `${name}:${options.join(',')}` : term;
  }).join('+');
}

// Methods keep the name that was given; equal names are numbered.
function labelsOf(all) {
  const names = all.map(method => String(method.gi || 'unnamed'));
  return names.map((name, i) => {
    const before = names.slice(0, i).filter(other => other === name).length;
    return before ? `${name} #${before + 1}` : name;
  });
}

const labels = labelsOf(methods);

// The options that differ from the defaults, for a tooltip.
function changesText(method) {
  const changed = Object.entries(method.changed ?? {}).flatMap(([technique, options]) =>
    Object.entries(options ?? {}).map(([option, value]) => `${technique}:${option}=${value}`));
  return changed.length ? `Differs from the defaults: ${changed.join(', ')}` : 'All options have their defaults';
}

// One colour for each method, everywhere on the page.
const methodColour = i => getComputedStyle(document.documentElement).getPropertyValue(`--method-${i % 16}`).trim();

function colourChip(i) {
  const chip = element('span', { className: 'chip', 'aria-hidden': 'true' });
  chip.style.backgroundColor = `var(--method-${i % 16})`;
  return chip;
}
