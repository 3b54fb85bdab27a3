// Page header, tables of details, tooltips, and start-up.

// ---- tooltips, for pointer and keyboard focus

const tip = element('div', { className: 'tip', id: 'tip', role: 'tooltip', hidden: true });

function showTip(target, text) {
  tip.textContent = text;
  tip.hidden = false;
  const box = target.getBoundingClientRect(), edge = 8;
  const left = clamp(box.left + box.width / 2 - tip.offsetWidth / 2, edge, innerWidth - tip.offsetWidth - edge);
  const above = box.top - tip.offsetHeight - edge;
  tip.style.left = `${Math.max(left, edge)}px`;
  tip.style.top = `${above > edge ? above : box.bottom + edge}px`;
}

function explain(target, text) {
  target.setAttribute('aria-describedby', 'tip');
  target.setAttribute('aria-label', `${target.textContent}. ${text}`);
  for (const event of ['pointerenter', 'focus']) target.addEventListener(event, () => showTip(target, text));
  for (const event of ['pointerleave', 'blur']) target.addEventListener(event, () => (tip.hidden = true));
}

// ---- header

function buildHead() {
  const scene = String(report.scene ?? 'Comparison');
  byId('scene').textContent = scene;
  document.title = `${scene} – Afterglow comparison`;
  const size = Array.isArray(report.size) ? `${report.size[0]} × ${report.size[1]} px` : null;
  const facts = [
    ['Size', size], [report.camera_is_default ? 'Camera (default)' : 'Camera', report.camera],
    [report.light_is_default ? 'Light (default)' : 'Light', report.light === '' ? 'of the scene' : report.light], ['Exposure', isNumber(report.exposure_ev) ? `EV ${numberText(report.exposure_ev, 2)}` : null],
    ['Frames timed', framesTimed], ['Device', report.device, report.driver], ['Afterglow', report.version],
    ['Date', report.date ? `${String(report.date).slice(0, 16).replace('T', ' ')} UTC` : null],
  ];
  byId('facts').append(...facts.filter(([, value]) => value !== null && value !== undefined).map(([name, value, more]) =>
    element('div', { title: more ? `Driver: ${more}` : undefined }, element('dt', {}, name), element('dd', {}, String(value)))));
}

function buildCommand() {
  if (!report.command) return;
  byId('command').hidden = false;
  byId('command').firstChild.textContent = report.command;
}

function buildReference() {
  const reference = report.reference;
  if (!reference) return;
  const spp = isNumber(reference.spp) ? `, ${reference.spp} ${reference.spp === 1 ? 'sample' : 'samples'} per pixel` : '';
  const bounces = reference.bounces === null ? ', unlimited bounces'
    : reference.bounces === 0 ? ', direct light only'
    : isNumber(reference.bounces) ? `, ${reference.bounces} ${reference.bounces === 1 ? 'bounce' : 'bounces'} of indirect light` : '';
  const cost = [
    isNumber(reference.rays) ? `${countText(reference.rays)} rays` : null,
    isNumber(reference.seconds) ? `${secondsText(reference.seconds)}${reference.cached ? ', cached' : ''}` : null,
  ].filter(Boolean).join(' in ');
  const noise = isNumber(reference.noise) ? element('button', { type: 'button', className: 'term' },
    `noise ${numberText(100 * reference.noise, decimalsFor([100 * reference.noise]) ? 1 : 0)} %`) : null;
  if (noise) explain(noise, 'Standard error of the reference (root mean square over all pixels), relative to its mean. It adds to the ' +
    'error of every method' + (isNumber(reference.noise_relmse)
    ? `: a perfect image would have a relMSE of ${numberText(reference.noise_relmse)}.` : '.') + ' More samples per pixel reduce it.');
  byId('reference').append(element('b', {}, 'Reference'), ` path traced${spp}${bounces}`, ...(noise ? [', ', noise] : []),
    cost ? ` (${cost}).` : '.');
}

// ---- tables of all values

function figuresTable(title, unit, names, valueOf) {
  if (!names.length) return null;
  const body = names.map(name => {
    const values = methods.map(method => valueOf(method, name));
    return element('tr', {}, element('th', { scope: 'row' }, name),
      ...values.map(value => element('td', {}, isNumber(value) ? numberText(value, 2) : '–')));
  });
  return element('details', { className: 'more' }, element('summary', {}, title),
    element('div', { className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': title }, element('table', { className: 'figures plain' },
      element('thead', {}, element('tr', {}, element('th', { scope: 'col', className: 'corner' }, unit), ...labels.map(label => element('th', { scope: 'col' }, label)))),
      element('tbody', {}, ...body))));
}

function buildDetails() {
  const owners = [...new Set(methods.flatMap(method => Object.keys(method.memory_bytes ?? {})))];
  const tables = [
    figuresTable('Milliseconds of each pass', 'ms, median', passNames(),
      (method, name) => passMs((method.passes ?? []).find(pass => pass.name === name))),
    figuresTable('Memory by owner', 'MiB', owners, (method, owner) => {
      const bytes = method.memory_bytes?.[owner];
      return isNumber(bytes) ? bytes / MEBIBYTE : undefined;
    }),
  ];
  byId('details').append(...tables.filter(Boolean));
}

document.body.append(tip);
buildHead();
buildCommand();
buildReference();
buildTable(showMethod);
buildViewer();
buildCharts(showMethod);
buildDetails();
