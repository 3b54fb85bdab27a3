// maps.mjs FOLDER…: the maps of a light map agree, read by programs of others: each texel of irradiance.ktx2 and of
// irradiance.png is that of irradiance.exr within the step of its format; scene.glb has the PNG, once, and its range. Of several
// pages each is like that, and each material has the texture of its primitives' page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { read } from 'ktx-parse';
import { PNG } from 'pngjs';
import { FloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

const file = (folder, name) => new Uint8Array(readFileSync(`${folder}/${name}`)); // with a buffer of its own

// Rows go up in three.js, which reads the last one first.
function readExr(folder, name) {
  const exr = new EXRLoader().setDataType(FloatType).parse(file(folder, `${name}.exr`).buffer);
  const { width, height, data } = exr;
  return { width, height, at: (x, y, c) => data[4 * ((height - 1 - y) * width + x) + c] };
}

function checkKtx2(folder, name, exr) {
  const ktx = read(file(folder, `${name}.ktx2`));
  const [descriptor] = ktx.dataFormatDescriptor;
  assert.deepEqual([ktx.vkFormat, ktx.typeSize, ktx.pixelWidth, ktx.pixelHeight, ktx.pixelDepth], [123, 4, exr.width, exr.height, 0]);
  assert.deepEqual([ktx.layerCount, ktx.faceCount, ktx.levels.length, ktx.supercompressionScheme], [0, 1, 1, 0]);
  assert.deepEqual([descriptor.colorModel, descriptor.colorPrimaries, descriptor.transferFunction], [1, 1, 1]);
  assert.equal(descriptor.samples.length, 6);
  assert.equal(ktx.keyValue.KTXorientation, 'rd');
  const scale = parseFloat(new TextDecoder().decode(ktx.keyValue['afterglow.scale']));
  const level = ktx.levels[0].levelData, words = new DataView(level.buffer, level.byteOffset, level.byteLength);
  assert.equal(level.byteLength, 4 * exr.width * exr.height);
  let most = 0, lit = 0;
  for (let i = 0; i < exr.width * exr.height; i++) {
    const word = words.getUint32(4 * i, true), step = scale * 2 ** ((word >>> 27) - 24);
    for (let c = 0; c < 3; c++) {
      const off = Math.abs((word >>> 9 * c & 511) * step - exr.at(i % exr.width, Math.floor(i / exr.width), c));
      most = Math.max(most, off / step);
      lit += word !== 0;
    }
  }
  assert(lit > 0 && most <= 0.5, `${folder}: a texel is off by ${most} steps`);
  return { scale, most };
}

function readGlb(folder) {
  const glb = file(folder, 'scene.glb'), length = new DataView(glb.buffer).getUint32(12, true);
  return { json: JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + length))), buffer: glb.subarray(28 + length) };
}

const extensionOf = material => material?.extensions?.MOZ_lightmap;

// Extensions of materials that the primitives of a page have.
function extensionsOf(json, page) {
  const all = json.meshes.flatMap(mesh => mesh.primitives).filter(p => p.extras?.afterglow_lightmap && (p.extras.afterglow_lightmap.page ?? 0) === page);
  return [...new Set(all.map(p => json.materials[p.material]))].map(extensionOf).filter(Boolean);
}

function checkPng(folder, name, page, { json, buffer }, exr) {
  const lit = extensionsOf(json, page);
  assert(lit.length > 0 && new Set(lit.map(map => map.index)).size === 1);
  const view = json.bufferViews[json.images[json.textures[lit[0].index].source].bufferView];
  const bytes = buffer.subarray(view.byteOffset, view.byteOffset + view.byteLength);
  assert.deepEqual(bytes, file(folder, `${name}.png`));
  const maps = json.extras.afterglow_lightmap.maps, range = lit[0].intensity;
  assert.equal(maps.find(map => map.uri === `${name}.png`).scale, range);
  const png = PNG.sync.read(Buffer.from(bytes));
  assert.deepEqual([png.width, png.height], [exr.width, exr.height]);
  let clipped = 0, most = 0, count = 0;
  for (let i = 0; i < exr.width * exr.height; i++) {
    const given = [0, 1, 2].map(c => exr.at(i % exr.width, Math.floor(i / exr.width), c) / range * 255);
    if (Math.max(...given) > 0) count++;
    if (Math.max(...given) > 255) clipped++;
    else given.forEach((value, c) => { most = Math.max(most, Math.abs(png.data[4 * i + c] - value)); });
  }
  assert(most < 1 && clipped <= count / 1000, `${folder}: a texel is off by ${most} steps, ${clipped} are clipped`);
  return { range, most, clipped, sets: new Set(lit.map(map => map.texCoord)).size, materials: lit.length };
}

for (const folder of process.argv.slice(2)) {
  const glb = readGlb(folder), maps = glb.json.extras.afterglow_lightmap.maps.filter(map => map.format === 'exr' && map.side === 'front');
  const textures = new Set(glb.json.materials.map(extensionOf).filter(Boolean).map(map => map.index));
  assert.equal(textures.size, maps.length);
  for (const { uri, page, width, height } of maps) {
    const name = uri.replace(/\.exr$/, ''), exr = readExr(folder, name);
    assert.deepEqual([exr.width, exr.height, maps.length > 1], [width, height, page !== undefined]);
    const ktx = checkKtx2(folder, name, exr), png = checkPng(folder, name, page ?? 0, glb, exr);
    console.log(`${folder}: ${name}: ${exr.width}x${exr.height}; KTX2 within ${ktx.most} steps, 1 is ${ktx.scale} lx; PNG within ${png.most.toFixed(3)} steps, ` +
      `255 is ${png.range.toFixed(1)} lx, ${png.clipped} texels clipped; ${png.materials} materials`);
  }
}
