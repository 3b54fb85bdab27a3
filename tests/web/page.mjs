// page.mjs ROOT QUERY SIZE FILE…: opens index.html of examples/web in headless Chromium and writes its canvas as PNG. ROOT has the
// folders that the query names. Several: QUERY SIZE FILE again.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const [, , chromium, examples, root, ...rest] = process.argv;
const here = dirname(fileURLToPath(import.meta.url)); // with node_modules
const types = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json' };

const server = createServer((request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
  for (const folder of [examples, here, root])
    try {
      const bytes = readFileSync(join(folder, path));
      response.writeHead(200, { 'Content-Type': types[extname(path)] ?? 'application/octet-stream' }).end(bytes);
      return;
    } catch { /* in another folder */ }
  response.writeHead(404).end();
});
await new Promise(done => server.listen(0, '127.0.0.1', done));

// Chromium's debugging pipe: JSON, each ended by a zero byte.
const profile = mkdtempSync(join(root, 'browser-'));
const browser = spawn(chromium, ['--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--hide-scrollbars', '--no-first-run', '--disable-background-networking', '--disable-dev-shm-usage', '--remote-debugging-pipe',
  `--user-data-dir=${profile}`, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
const waiting = new Map(), complaints = [];
let pending = '', last = 0, session;
browser.stdio[4].setEncoding('utf8').on('data', text => {
  const parts = (pending + text).split('\0');
  pending = parts.pop();
  for (const message of parts.map(part => JSON.parse(part))) {
    if (message.method === 'Runtime.exceptionThrown') complaints.push(JSON.stringify(message.params.exceptionDetails));
    if (message.method === 'Runtime.consoleAPICalled' && message.params.type === 'error') complaints.push(JSON.stringify(message.params.args));
    const done = waiting.get(message.id);
    waiting.delete(message.id);
    if (done) message.error ? done.fail(new Error(message.error.message)) : done.give(message.result);
  }
});
function call(method, params = {}) {
  const id = ++last;
  browser.stdio[3].write(JSON.stringify({ id, method, params, sessionId: session }) + '\0');
  return new Promise((give, fail) => waiting.set(id, { give, fail }));
}
const value = async expression => (await call('Runtime.evaluate', { expression, returnByValue: true })).result.value;

const page = (await call('Target.getTargets')).targetInfos.find(target => target.type === 'page');
session = (await call('Target.attachToTarget', { targetId: page.targetId, flatten: true })).sessionId;
await call('Runtime.enable');
for (let i = 0; i < rest.length; i += 3) {
  const [query, size, file] = rest.slice(i, i + 3), [width, height] = size.split('x').map(Number);
  await call('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
  await call('Page.navigate', { url: `http://127.0.0.1:${server.address().port}/index.html?${query}` });
  const end = Date.now() + 90000;
  while (await value('document.title') !== 'ready' && complaints.length === 0 && Date.now() < end) await new Promise(done => setTimeout(done, 100));
  if (complaints.some(text => text.includes('creating WebGL context'))) {
    console.log('skipped: no WebGL in Chromium');
    browser.kill();
    process.exit(77);
  }
  assert.deepEqual(complaints, []);
  assert.equal(await value('document.title'), 'ready', `${query}: not drawn in time`);
  const url = await value(`document.querySelector('canvas').toDataURL()`);
  writeFileSync(file, Buffer.from(url.split(',')[1], 'base64'));
}
browser.kill();
await new Promise(done => browser.on('exit', done));
rmSync(profile, { recursive: true, force: true });
server.close();
