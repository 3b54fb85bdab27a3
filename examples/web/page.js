// A scene with its light map, and a ball that probes light; README.md has the parameters.
import * as THREE from 'three';
import { LightProbeGridWebGL } from 'three/addons/lighting/LightProbeGridWebGL.js';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

const params = new URLSearchParams(location.search), of = (name, fallback) => params.get(name) ?? fallback;
const folder = of('maps', 'maps'), probes = of('probes', null);
const renderer = new THREE.WebGLRenderer({ antialias: of('antialias', 'on') === 'on', preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
renderer.autoClear = false;
renderer.shadowMap.enabled = true;
renderer.toneMapping = THREE.NeutralToneMapping; // `afterglow render --tonemap neutral --exposure EV`
renderer.toneMappingExposure = 2 ** -parseFloat(of('ev', '0')) / 1.2;
document.body.append(renderer.domElement);

// A texel times the scale is irradiance in lux, which `lightMap` of three.js is, too.
async function loadMap(map) {
  const loader = map.format === 'ktx2' ? new KTX2Loader().detectSupport(renderer) : new THREE.TextureLoader();
  const texture = await loader.loadAsync(`${folder}/${map.uri}`);
  // Texels of other charts are near: no mip maps.
  Object.assign(texture, { flipY: false, generateMipmaps: false, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, needsUpdate: true });
  return { texture, intensity: map.scale };
}

const loadPages = ({ extras }) => Promise.all(extras.afterglow_lightmap.maps
  .filter(map => map.format === of('format', 'ktx2') && map.side === 'front').map(loadMap));

function giveMap(mesh, pages) {
  const { texture, intensity } = pages[mesh.geometry.userData.afterglow_lightmap?.page ?? 0]; // materials are of one page
  const { material } = mesh, extension = material.userData.gltfExtensions?.MOZ_lightmap; // GLTFLoader keeps what it does not know
  mesh.castShadow = mesh.receiveShadow = true;
  material.shadowSide = THREE.DoubleSide; // walls of one side cast shadows, too
  if (!extension || material.lightMap) return;
  material.lightMap = texture.clone();
  material.lightMap.channel = extension.texCoord;
  material.lightMapIntensity = intensity;
  material.aoMap = null; // the map has the occlusion
}

// The shadow map of a sun covers the scene.
function castShadows(light, box) {
  const { shadow, target } = light, { camera } = shadow;
  light.castShadow = true;
  shadow.mapSize.setScalar(8192);
  Object.assign(shadow, { normalBias: 0.005, bias: -0.0002 });
  if (!light.isDirectionalLight) return;
  light.getWorldPosition(camera.position);
  camera.lookAt(target.getWorldPosition(new THREE.Vector3()));
  camera.updateMatrixWorld();
  const { min, max } = box.clone().applyMatrix4(camera.matrixWorldInverse);
  Object.assign(camera, { left: min.x, right: max.x, bottom: min.y, top: max.y, near: -max.z, far: -min.z });
}

// Copies of all lights shine on the ball. On surfaces those shine whose direct light the map does not have.
function shareLights(scene, objects, box) {
  const lights = [];
  scene.traverse(object => object.isLight && lights.push(object));
  for (const light of lights) {
    const { direct, indirect } = light.userData.afterglow_lightmap, copy = light.clone();
    light.matrixWorld.decompose(copy.position, copy.quaternion, copy.scale);
    copy.target = light.target;
    if (indirect) objects.add(copy); // else the map was made without it
    light.visible = indirect && !direct;
    if (light.visible) castShadows(light, box);
  }
}

async function loadProbes() {
  const { grid, atlas } = await (await fetch(`${probes}/probes.json`)).json(), { counts, spacing, first } = grid;
  const exr = await new EXRLoader().setDataType(THREE.FloatType).loadAsync(`${probes}/${atlas}`);
  const light = new LightProbeGridWebGL(...counts.map(count => count * spacing), ...counts);
  light.texture = new THREE.Data3DTexture(exr.image.data, counts[0], counts[1], 7 * (counts[2] + 2));
  Object.assign(light.texture, { type: THREE.FloatType, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, needsUpdate: true });
  light.position.fromArray(first.map((value, a) => value + spacing * (counts[a] - 1) / 2));
  light.updateBoundingBox();
  return light;
}

const gltf = await new GLTFLoader().loadAsync(`${folder}/scene.glb`), scene = new THREE.Scene(), objects = new THREE.Scene();
const pages = await loadPages(gltf.parser.json), box = new THREE.Box3().setFromObject(gltf.scene);
const center = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
scene.add(gltf.scene);
scene.updateMatrixWorld(true);
scene.traverse(object => object.isMesh && giveMap(object, pages));
shareLights(scene, objects, box);
const radiance = gltf.scene.userData.afterglow_sky;
if (radiance) { // a background colour would have no tone curve
  const material = new THREE.MeshBasicMaterial({ color: new THREE.Color(...radiance), side: THREE.BackSide });
  scene.add(new THREE.Mesh(new THREE.SphereGeometry(100 * size.length()), material));
}
const camera = gltf.cameras[0] ?? new THREE.PerspectiveCamera(60);
if (!gltf.cameras[0]) camera.position.set(0, 0, size.length()).add(center);
Object.assign(camera, { aspect: innerWidth / innerHeight, near: 0.01, far: 1000 * size.length() });
camera.updateProjectionMatrix();
const ball = new THREE.Mesh(new THREE.SphereGeometry(0.06 * size.y, 48, 24), new THREE.MeshStandardMaterial({ color: 0xcccccc, roughness: 1 }));
if (probes) objects.add(ball, await loadProbes());

function draw(ms) {
  const angle = 0.8 * parseFloat(of('time', ms / 1000));
  ball.position.set(0.3 * size.x * Math.cos(angle), -0.1 * size.y, 0.3 * size.z * Math.sin(angle)).add(center);
  renderer.clear();
  renderer.render(scene, camera);
  renderer.render(objects, camera);
  document.title = 'ready';
  requestAnimationFrame(draw);
}
requestAnimationFrame(draw);
