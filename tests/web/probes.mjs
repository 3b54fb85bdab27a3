// probes.mjs SCHEMA FOLDER…: probes.json fits its schema; the atlas, as three.js reads it, is that of its LightProbeGrid: the
// formula of its shader gives the irradiance of probes.json.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import Ajv from 'ajv/dist/2020.js';
import { FloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

const [, , schema, ...folders] = process.argv;
const fits = new Ajv({ strict: false }).compile(JSON.parse(readFileSync(schema)));
const readExr = path => new EXRLoader().setDataType(FloatType).parse(new Uint8Array(readFileSync(path)).buffer);

// Irradiance by orthonormal spherical harmonics.
function irradiance(c, [x, y, z]) {
  const basis = [0.2820948, 0.4886025 * y, 0.4886025 * z, 0.4886025 * x, 1.0925484 * x * y, 1.0925484 * y * z,
    0.3153916 * (3 * z * z - 1), 1.0925484 * x * z, 0.5462742 * (x * x - y * y)];
  return [0, 1, 2].map(k => basis.reduce((sum, value, i) => sum + value * c[3 * i + k], 0));
}

// As getLightProbeGridIrradiance of three.js 0.187, whose constants have six digits.
function ofGrid(c, [x, y, z]) {
  const factors = [0.886227, 1.023328 * y, 1.023328 * z, 1.023328 * x, 0.858086 * x * y, 0.858086 * y * z,
    0.743125 * z * z - 0.247708, 0.858086 * x * z, 0.429043 * (x * x - y * y)];
  return [0, 1, 2].map(k => factors.reduce((sum, value, i) => sum + value * c[3 * i + k], 0));
}

for (const folder of folders) {
  const json = JSON.parse(readFileSync(`${folder}/probes.json`)), [nx, ny, nz] = json.grid.counts, count = nx * ny * nz;
  assert(fits(json), JSON.stringify(fits.errors));
  assert.equal(json.coefficients.length, 27 * count);
  const atlas = readExr(`${folder}/${json.atlas}`);
  assert.equal(atlas.width * atlas.height, nx * ny * 7 * (nz + 2));
  const texel = (part, slice, i, c) => atlas.data[4 * ((part * (nz + 2) + slice) * nx * ny + i) + c];
  const directions = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0.6, 0.48, -0.64]];
  let most = 0, brightest = 0;
  for (let probe = 0; probe < count; probe++) {
    const z = Math.floor(probe / (nx * ny)), i = probe % (nx * ny);
    const packed = Array.from({ length: 27 }, (_, k) => texel(Math.floor(k / 4), z + 1, i, k % 4));
    for (const n of directions) {
      const e = irradiance(json.coefficients.slice(27 * probe, 27 * probe + 27), n), grid = ofGrid(packed, n);
      brightest = Math.max(brightest, ...e);
      for (let k = 0; k < 3; k++) most = Math.max(most, Math.abs(e[k] - grid[k]));
    }
    for (let part = 0; part < 7; part++) { // first and last slices are repeated
      assert.equal(texel(part, 0, i, 0), texel(part, 1, i, 0));
      assert.equal(texel(part, nz + 1, i, 3), texel(part, nz, i, 3));
    }
  }
  assert(brightest > 0 && most <= 1e-5 * brightest, `${folder}: off by ${most} of ${brightest} lx`);
  let tiles = json.visibility.kind;
  if (json.visibility.kind === 'depths') {
    const { tile_side: side, columns, file, offsets } = json.visibility, map = readExr(`${folder}/${file}`);
    assert.deepEqual([map.width, map.height], [side * columns, side * Math.ceil(count / columns)]);
    assert.equal(offsets.length, 4 * count);
    for (let probe = 0; probe < count; probe++) {
      const left = probe % columns * side, low = Math.floor(probe / columns) * side;
      for (let k = 0; k < side * side; k++) {
        const depth = map.data[4 * ((low + Math.floor(k / side)) * map.width + left + k % side)];
        assert(offsets[4 * probe + 3] === 0 || depth >= 0.29 && depth <= 32.1, `${folder}: depth ${depth}`);
      }
    }
    tiles += `, ${count} tiles of ${side}x${side}`;
  }
  console.log(`${folder}: ${nx}x${ny}x${nz} probes, within ${(most / brightest).toExponential(1)} of three.js' formula; visibility: ${tiles}`);
}
