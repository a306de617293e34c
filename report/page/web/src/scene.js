// The part and a few light paths in three dimensions: three.js on WebGL, else the same as a still drawing.
import {
  AmbientLight,
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  Scene,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { drawStill } from "./still.js";
import { colour } from "./theme.js";

/** z of the part is up; three.js looks along its own z. */
function flat(points) {
  return points.flat();
}

function boundsOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const p of points)
    for (let k = 0; k < 3; ++k) {
      low[k] = Math.min(low[k], p[k]);
      high[k] = Math.max(high[k], p[k]);
    }
  return { middle: low.map((l, k) => (l + high[k]) / 2), size: Math.hypot(...low.map((l, k) => high[k] - l)) };
}

function solidOf(scene) {
  const group = new Group();
  const faces = new BufferGeometry();
  faces.setAttribute("position", new Float32BufferAttribute(flat(scene.triangles.flat().map((v) => scene.vertices[v])), 3));
  faces.computeVertexNormals();
  const glass = new MeshLambertMaterial({ transparent: true, opacity: 0.28, side: DoubleSide, depthWrite: false });
  group.add(new Mesh(faces, glass));
  const edges = new BufferGeometry();
  edges.setAttribute("position", new Float32BufferAttribute(flat(scene.edges.flat().map((v) => scene.vertices[v])), 3));
  const lines = new LineBasicMaterial({ transparent: true, opacity: 0.55 });
  group.add(new LineSegments(edges, lines));
  const paint = () => {
    glass.color = new Color(colour("--glass"));
    lines.color = new Color(colour("--edge"));
  };
  return { group, paint };
}

/** A rod along a piece of a path, with an arrow in the middle of long ones. Lines of WebGL are one pixel wide. */
function addPiece(group, from, to, thick, material) {
  const along = to.clone().sub(from);
  const length = along.length();
  if (length < 1e-9) return;
  const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.clone().divideScalar(length));
  const add = (geometry, share) => {
    const mesh = new Mesh(geometry, material);
    mesh.quaternion.copy(turn);
    mesh.position.copy(from).addScaledVector(along, share);
    group.add(mesh);
  };
  add(new CylinderGeometry(thick, thick, length, 8, 1, true), 0.5);
  if (length > 14 * thick) add(new ConeGeometry(3 * thick, 8 * thick, 12), 0.55);
}

function pathOf(path, index, size) {
  const group = new Group();
  const material = new MeshBasicMaterial();
  const points = path.points.map((p) => new Vector3(...p));
  for (let k = 1; k < points.length; ++k) addPiece(group, points[k - 1], points[k], 0.0035 * size, material);
  const ball = new SphereGeometry(0.008 * size, 12, 8);
  for (const p of points.slice(1, -1)) {
    const mesh = new Mesh(ball, material);
    mesh.position.copy(p);
    group.add(mesh);
  }
  const paint = () => (material.color = new Color(colour(`--curve-${index % 7}`)));
  return { group, paint };
}

function webglOf(view) {
  try {
    const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    view.append(renderer.domElement);
    return renderer;
  } catch (error) {
    return null;
  }
}

/** The list of paths beside the view: which one is shown, and what happens to its light. */
function listPaths(scene, chosen) {
  const list = document.getElementById("scene-paths");
  const steps = document.getElementById("scene-steps");
  const tell = (index) => {
    steps.replaceChildren(
      ...(index < 0 ? [] : scene.paths[index].events).map((text) => {
        const item = document.createElement("li");
        item.textContent = text;
        return item;
      }),
    );
    chosen(index);
  };
  const add = (index, text) => {
    const label = document.createElement("label");
    const input = document.createElement("input");
    input.type = "radio";
    input.name = "path";
    input.value = String(index);
    input.checked = index === 0;
    input.addEventListener("change", () => tell(index));
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    if (index >= 0) swatch.style.background = `var(--curve-${index % 7})`;
    label.append(input, swatch, text);
    list.append(label);
  };
  scene.paths.forEach((path, index) => add(index, path.label));
  if (scene.paths.length > 1) add(-1, "all of them");
  if (scene.paths.length > 0) tell(0);
}

function addKeys(view, camera, controls, draw) {
  view.addEventListener("keydown", (event) => {
    const offset = camera.position.clone().sub(controls.target);
    const up = new Vector3(0, 0, 1);
    const side = new Vector3().crossVectors(up, offset).normalize();
    const turns = { ArrowLeft: [up, -0.12], ArrowRight: [up, 0.12], ArrowUp: [side, -0.12], ArrowDown: [side, 0.12] };
    if (turns[event.key]) {
      const turned = offset.clone().applyAxisAngle(...turns[event.key]);
      // Over the pole the picture would turn upside down.
      if (Math.abs(turned.clone().normalize().z) > 0.995) return;
      offset.copy(turned);
    } else if (event.key === "+") offset.multiplyScalar(0.85);
    else if (event.key === "-") offset.multiplyScalar(1 / 0.85);
    else return;
    event.preventDefault();
    camera.position.copy(controls.target).add(offset);
    controls.update();
    draw();
  });
}

export function startScene(view, scene) {
  const renderer = webglOf(view);
  if (!renderer) {
    view.dataset.renderer = "svg";
    let shown = 0;
    const draw = () => drawStill(view, scene, shown);
    listPaths(scene, (index) => {
      shown = index;
      draw();
    });
    draw();
    return draw;
  }
  view.dataset.renderer = "webgl";
  const bounds = boundsOf([...scene.vertices, ...scene.paths.flatMap((path) => path.points)]);
  const world = new Scene();
  const sky = new AmbientLight(0xffffff, 1.6);
  const sun = new DirectionalLight(0xffffff, 2.2);
  sun.position.set(0.4, -0.7, 1);
  world.add(sky, sun);
  const solid = solidOf(scene);
  world.add(solid.group);
  const paths = scene.paths.map((path, index) => pathOf(path, index, bounds.size));
  paths.forEach((path) => world.add(path.group));

  const camera = new PerspectiveCamera(32, 1, 0.01 * bounds.size, 20 * bounds.size);
  camera.up.set(0, 0, 1);
  camera.position.set(
    bounds.middle[0] + 0.75 * bounds.size,
    bounds.middle[1] - 1.45 * bounds.size,
    bounds.middle[2] + 0.55 * bounds.size,
  );
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.set(...bounds.middle);
  controls.enableDamping = false;
  controls.enableZoom = false; // the wheel scrolls the page; + and - come nearer
  controls.update();

  const draw = () => {
    solid.paint();
    paths.forEach((path) => path.paint());
    renderer.render(world, camera);
    view.dataset.camera = camera.position.toArray().map((c) => c.toFixed(4)).join(" ");
  };
  const fit = () => {
    const width = Math.max(200, view.clientWidth);
    const height = Math.max(200, view.clientHeight);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  };
  controls.addEventListener("change", draw);
  addKeys(view, camera, controls, draw);
  listPaths(scene, (index) => {
    paths.forEach((path, k) => (path.group.visible = index < 0 || index === k));
    draw();
  });
  new ResizeObserver(fit).observe(view);
  fit();
  return draw;
}
