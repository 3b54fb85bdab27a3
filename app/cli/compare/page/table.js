// Table of methods: sortable by column, with the best value of each column marked.

const order = { metric: null, reversed: false }; // best first; reversed: worst first; no metric: original order

function sortedMethods() {
  const indices = methods.map((_, i) => i);
  if (!order.metric) return indices;
  const bad = i => badness(order.metric, order.metric.value(methods[i]));
  const sign = order.reversed ? -1 : 1;
  return indices.sort((a, b) => {
    const x = bad(a), y = bad(b);
    if (x === Infinity || y === Infinity) return (x === Infinity) - (y === Infinity); // missing ones last, either way
    return sign * (x - y) || a - b;
  });
}

// Cycles through best first, worst first, original order.
function nextOrder(metric) {
  if (order.metric !== metric) Object.assign(order, { metric, reversed: false });
  else if (!order.reversed) order.reversed = true;
  else Object.assign(order, { metric: null, reversed: false });
}

function headingOf(metric, rebuild) {
  const active = order.metric === metric;
  const rising = active && (metric.better !== 'high') !== order.reversed;
  const button = element('button', { type: 'button', className: 'sort' }, metric.name,
    element('span', { className: 'arrow', 'aria-hidden': 'true' }, active ? (rising ? '↑' : '↓') : ''));
  explain(button, `${metric.meaning} Unit: ${metric.unit}. ${DIRECTION[metric.better]}`);
  button.addEventListener('click', () => {
    nextOrder(metric);
    rebuild(metric);
  });
  const sort = active ? (rising ? 'ascending' : 'descending') : 'none';
  return element('th', { scope: 'col', 'aria-sort': sort, 'data-metric': metric.name }, button);
}

// Adjacent columns of a group share a heading.
function groupHeadings(columns) {
  const groups = [];
  for (const { group } of columns)
    if (groups.length && groups[groups.length - 1].group === group) groups[groups.length - 1].span++;
    else groups.push({ group, span: 1 });
  return groups.map(({ group, span }) =>
    element('th', { scope: 'colgroup', colSpan: span, className: 'group' }, group));
}

// The name (a click shows the method in the viewer) and the GI spec with all options.
function nameCell(i, show) {
  const button = element('button', { type: 'button', className: 'method' }, colourChip(i), labels[i]);
  explain(button, `${changesText(methods[i])}. Click: compare with the reference.`);
  button.addEventListener('click', () => show(i));
  const count = Object.keys(optionsOf(methods[i])).length;
  const options = count ? element('details', { className: 'options' },
    element('summary', {}, count === 1 ? '1 option' : `${count} options`),
    element('code', {}, `--gi ${specOf(methods[i])}`)) : null;
  return element('th', { scope: 'row' }, button, options);
}

function buildTable(show) {
  const table = byId('table');
  const columns = METRICS.filter(metric => !metric.hidden && isMeasured(metric));
  const decimals = new Map(columns.map(metric => [metric, decimalsFor(valuesOf(metric))]));
  const best = new Map(columns.map(metric => [metric, Math.min(...methods.map(m => badness(metric, metric.value(m))))]));

  function cell(metric, i) {
    const value = metric.value(methods[i]);
    const isBest = methods.length > 1 && isNumber(value) && badness(metric, value) === best.get(metric);
    const text = numberText(value, decimals.get(metric));
    return element('td', { className: isBest ? 'best' : '', title: isNumber(value) ? `${value}` : 'not measured' }, text,
      isBest ? element('span', { className: 'unseen' }, ' best') : null);
  }
  function fill(clicked) {
    const first = element('th', { scope: 'col', rowSpan: 2, className: 'corner' }, 'Method');
    table.replaceChildren(
      element('thead', {}, element('tr', {}, first, ...groupHeadings(columns)),
        element('tr', {}, ...columns.map(metric => headingOf(metric, fill)))),
      element('tbody', {}, ...sortedMethods().map(i =>
        element('tr', { 'data-method': i }, nameCell(i, show), ...columns.map(metric => cell(metric, i))))));
    markShown();
    if (clicked) table.querySelectorAll('.sort')[columns.indexOf(clicked)].focus();
  }
  fill();
  byId('methods').hidden = methods.length === 0;
  byId('table-legend').replaceChildren(
    ...(methods.length > 1 ? [element('span', { className: 'best' }, 'Bold'), ': best of the column. '] : []),
    element('span', { className: 'shown' }, 'Marked row'), ': left image of the viewer.');
  byId('table-legend').append(...directText());
}

// How far the image is wrong where indirect light is exact.
function directText() {
  const direct = report.direct;
  if (!isNumber(direct?.relmse)) return [];
  return [element('br'), `Direct light alone, the same for all methods: relMSE ${numberText(direct.relmse)}, ` +
    `FLIP ${numberText(direct.flip)} of the image.`];
}

// Highlights the row of the method in the viewer.
let shown = -1;
function markShown(i = shown) {
  shown = i;
  for (const row of byId('table').querySelectorAll('tbody tr'))
    row.classList.toggle('shown', Number(row.dataset.method) === shown);
}
