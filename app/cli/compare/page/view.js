// One zoom and position for all images of the page, and the gestures that change them. Lengths are fractions of an
// image frame, so that all frames move together.

const view = { zoom: 1, x: 0, y: 0, split: 0.5 }; // x, y: the frame's upper left corner, within the zoomed image
const [WIDTH, HEIGHT] = Array.isArray(report.size) && report.size.every(isNumber) ? report.size : [16, 9];
const LARGEST_PIXEL = 64; // on the screen, at full zoom
const DRAG_STARTS = 4, GRIP_REACH = 24, SAME_GESTURE_MS = 250;
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const stage = byId('stage');
const pixelSize = () => stage.clientWidth * view.zoom / WIDTH;

function showView() {
  const style = byId('viewer').style;
  style.setProperty('--zoom', view.zoom);
  style.setProperty('--x', view.x);
  style.setProperty('--y', view.y);
  style.setProperty('--split', view.split);
  const tile = document.querySelector('.tile .view');
  const tileShare = tile && stage.clientWidth ? tile.clientWidth / stage.clientWidth : 0;
  byId('viewer').classList.toggle('large-pixels', pixelSize() >= 2);
  byId('viewer').classList.toggle('large-tile-pixels', pixelSize() * tileShare >= 2);
  byId('viewer').classList.toggle('zoomed', view.zoom > 1);
  byId('zoom').value = `${Math.round(100 * pixelSize())} %`;
  byId('split').value = Math.round(100 * view.split);
  byId('split').setAttribute('aria-valuetext', `${Math.round(100 * view.split)} % left image`);
  stage.dataset.side = view.split <= 0 ? 'right' : view.split >= 1 ? 'left' : 'both';
}

// Zooms about (px, py).
function zoomAt(px, py, factor) {
  const most = Math.max(LARGEST_PIXEL * WIDTH / Math.max(stage.clientWidth, 1), 8);
  const zoom = clamp(view.zoom * factor, 1, most);
  view.x = clamp((view.x + px) * zoom / view.zoom - px, 0, zoom - 1);
  view.y = clamp((view.y + py) * zoom / view.zoom - py, 0, zoom - 1);
  view.zoom = zoom;
  showView();
}

function panBy(dx, dy) {
  view.x = clamp(view.x - dx, 0, view.zoom - 1);
  view.y = clamp(view.y - dy, 0, view.zoom - 1);
  showView();
}

function splitAt(split) {
  view.split = clamp(split, 0, 1);
  showView();
}

function fitView() {
  Object.assign(view, { zoom: 1, x: 0, y: 0 });
  showView();
}

// Position of an event in a frame, 0…1.
function placeIn(frame, event) {
  const box = frame.getBoundingClientRect();
  return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
}

// ---- the wheel

// A wheel movement that began as scrolling or zooming continues as such. At the smallest zoom it scrolls.
const wheel = { last: -Infinity, zooms: false, fresh: true };
addEventListener('wheel', event => {
  wheel.fresh = event.timeStamp - wheel.last > SAME_GESTURE_MS;
  wheel.last = event.timeStamp;
  if (wheel.fresh) wheel.zooms = false;
}, { capture: true, passive: true });

function listenToWheel(frame) {
  frame.addEventListener('wheel', event => {
    if (wheel.fresh) wheel.zooms = event.ctrlKey || event.deltaY < 0 || view.zoom > 1;
    if (!wheel.zooms) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    const place = placeIn(frame, event);
    zoomAt(place.x, place.y, Math.exp(-pixels * (event.ctrlKey ? 0.01 : 0.002)));
  }, { passive: false });
}

// ---- pointers: one drags the divider or the image, two pinch

const nearDivider = (frame, place) => Math.abs(place.x - view.split) * frame.clientWidth <= GRIP_REACH;

function beginDrag(frame, event) {
  const place = placeIn(frame, event);
  const splits = frame === stage && (view.zoom <= 1 || nearDivider(frame, place));
  // A finger may begin to scroll the page: it moves the divider relatively, without a jump.
  if (splits && event.pointerType !== 'touch') splitAt(place.x);
  return { splits, moved: false, from: place, offset: view.split - place.x };
}

function continueDrag(frame, drag, before, place) {
  const distance = Math.hypot((place.x - drag.from.x) * frame.clientWidth, (place.y - drag.from.y) * frame.clientHeight);
  drag.moved ||= distance >= DRAG_STARTS;
  if (!drag.moved) return;
  if (drag.splits) splitAt(place.x + drag.offset);
  else panBy(place.x - before.x, place.y - before.y);
}

function pinch([a, b], [c, d]) {
  const length = (p, q) => Math.hypot((p.x - q.x) * WIDTH, (p.y - q.y) * HEIGHT);
  const middle = { x: (c.x + d.x) / 2, y: (c.y + d.y) / 2 };
  panBy(middle.x - (a.x + b.x) / 2, middle.y - (a.y + b.y) / 2);
  if (length(a, b) > 0) zoomAt(middle.x, middle.y, length(c, d) / length(a, b));
}

function listenToPointers(frame, clicked) {
  const pointers = new Map();
  let drag = null;
  const end = event => {
    if (!pointers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && drag && !drag.moved && pointers.size === 0) clicked(event);
    if (pointers.size === 0) drag = null;
    else drag = { splits: false, moved: true, from: [...pointers.values()][0], offset: 0 };
  };
  frame.addEventListener('pointerdown', event => {
    if (event.button !== 0 || event.target.closest('select')) return;
    frame.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, placeIn(frame, event));
    if (pointers.size === 1) drag = beginDrag(frame, event);
    else if (drag) drag.moved = true;
  });
  frame.addEventListener('pointermove', event => {
    const before = [...pointers.values()], old = pointers.get(event.pointerId), place = placeIn(frame, event);
    point(frame, place);
    if (!old) return;
    pointers.set(event.pointerId, place);
    if (pointers.size === 2) pinch(before, [...pointers.values()]);
    else if (pointers.size === 1) continueDrag(frame, drag, old, place);
  });
  frame.addEventListener('pointerup', end);
  frame.addEventListener('pointercancel', end);
  frame.addEventListener('pointerleave', () => point(null));
}

// Event handlers of every frame. clicked: a press without a drag.
function listenTo(frame, clicked = () => {}) {
  listenToWheel(frame);
  listenToPointers(frame, clicked);
  frame.addEventListener('dblclick', event => {
    if (event.target.closest('select')) return;
    fitView();
    if (frame === stage) splitAt(0.5);
  });
}
