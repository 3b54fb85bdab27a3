// The data of a page, formatting of numbers, and creation of elements.

const byId = id => document.getElementById(id);
const dataOf = id => JSON.parse(byId(`data-${id}`).textContent);
// Names may hold controls that reorder a line: shown as the program shows them.
const printable = text => text.replace(/[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g,
  control => `\\u${control.charCodeAt(0).toString(16).padStart(4, '0')}`);
const report = JSON.parse(byId('data-report').textContent, (key, value) => typeof value === 'string' ? printable(value) : value);
const images = dataOf('images'); // file name → data: URI

// An element with properties and children; text is never parsed as HTML.
function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === false || value === null) continue;
    if (key in made && !key.includes('-')) made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

const isNumber = value => typeof value === 'number' && Number.isFinite(value);

// Decimals so that the largest value of a column shows three digits and the smallest two; at most five.
function decimalsFor(values) {
  const sizes = values.filter(isNumber).map(Math.abs).filter(value => value > 0);
  if (!sizes.length) return 0;
  const digit = value => Math.floor(Math.log10(value));
  const wanted = Math.max(2 - digit(Math.max(...sizes)), 1 - digit(Math.min(...sizes)));
  return Math.min(Math.max(wanted, 0), 5);
}

function numberText(value, decimals = decimalsFor([value])) {
  if (!isNumber(value)) return '–';
  if (value !== 0 && Math.abs(value) < 0.5 * 10 ** -decimals) return value.toExponential(1).replace('-', '−');
  return value.toFixed(decimals).replace('-', '−');
}

// 38316784 → "38.3 million"
function countText(value) {
  for (const [size, word] of [[1e12, 'trillion'], [1e9, 'billion'], [1e6, 'million']])
    if (value >= size) return `${numberText(value / size)} ${word}`;
  return String(value);
}

function secondsText(seconds) {
  if (seconds < 60) return `${numberText(seconds, seconds < 10 ? 1 : 0)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}
