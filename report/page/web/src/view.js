// Three-dimensional view of a part and light paths, by three.js with WebGL. Without WebGL, it is a still drawing.
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
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  Scene,
  ShapeUtils,
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { drawStill } from "./still.js";
import { colour } from "./theme.js";

const FIELD_DEG = 32; // vertical field of view of the camera

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

/** Returns the name of the colour of a path: its own colour, or the colour for its index in the list of paths. */
export function colourOfPath(path, index) {
  return path.colour || `--curve-${index % 7}`;
}

function positions(points) {
  return new Float32BufferAttribute(points.flat(), 3);
}

/** Faces, edges and illuminated regions of the part. They are rebuilt when the scene changes. */
class Solid {
  constructor() {
    this.group = new Group();
    this.glass = new MeshLambertMaterial({ transparent: true, opacity: 0.28, side: DoubleSide, depthWrite: false });
    this.ink = new LineBasicMaterial({ transparent: true, opacity: 0.55 });
    this.lit = new MeshBasicMaterial({ transparent: true, side: DoubleSide, depthWrite: false, vertexColors: true });
    this.faces = new Mesh(new BufferGeometry(), this.glass);
    this.edges = new LineSegments(new BufferGeometry(), this.ink);
    this.patches = new Mesh(new BufferGeometry(), this.lit);
    this.group.add(this.faces, this.edges, this.patches);
  }

  show(scene) {
    for (const part of [this.faces, this.edges, this.patches]) part.geometry.dispose();
    const corners = (lists) => positions(lists.flat().map((v) => scene.vertices[v]));
    this.faces.geometry = new BufferGeometry().setAttribute("position", corners(scene.triangles));
    this.faces.geometry.computeVertexNormals();
    this.edges.geometry = new BufferGeometry().setAttribute("position", corners(scene.edges));
    this.ink.opacity = scene.edges.length > 200 ? 0.3 : 0.55;
    this.scene = scene;
  }

/** Creates the polygons on the entrance face. The opacity of each polygon is given in the scene. */
  light() {
    const points = [];
    const colours = [];
    for (const patch of this.scene.patches || []) {
      const paint = new Color(colour(patch.colour || "--active"));
      for (const triangle of ShapeUtils.triangulateShape(patch.points.map(([x, y]) => new Vector2(x, y)), []))
        for (const v of triangle) {
          points.push(patch.points[v]);
          colours.push(paint.r, paint.g, paint.b, patch.opacity);
        }
    }
    this.patches.geometry.dispose();
    this.patches.geometry = new BufferGeometry()
      .setAttribute("position", positions(points))
      .setAttribute("color", new Float32BufferAttribute(colours, 4));
  }

  paint() {
    this.glass.color = new Color((this.scene && this.scene.glass) || colour("--glass"));
    this.ink.color = new Color(colour("--edge"));
    if (this.scene) this.light();
  }
}

/**
 * Light paths as rods, with arrows near the centre of long segments and balls at events. Rods are used because WebGL
 * draws lines with a width of only one pixel. All rods, all arrows and all balls are one mesh each, with many instances,
 * so that changes are fast.
 */
class Paths {
  constructor() {
    this.group = new Group();
    this.material = new MeshBasicMaterial();
    this.kinds = {
      rod: new CylinderGeometry(1, 1, 1, 8, 1, true),
      arrow: new ConeGeometry(3, 8, 12),
      ball: new SphereGeometry(2.3, 12, 8),
    };
    this.meshes = {};
  }

  show(paths, size) {
    const wanted = { rod: [], arrow: [], ball: [] };
    for (const path of paths) this.collect(path, 0.0035 * size * (path.width || 1), wanted);
    for (const kind of Object.keys(wanted)) this.fill(kind, wanted[kind]);
  }

  collect(path, thick, wanted) {
    const points = path.points.map((p) => new Vector3(...p));
    const paint = new Color(colour(path.colour));
    const up = new Vector3(0, 1, 0);
    for (let k = 1; k < points.length; ++k) {
      const along = points[k].clone().sub(points[k - 1]);
      const length = along.length();
      if (length < 1e-9) continue;
      const turn = new Quaternion().setFromUnitVectors(up, along.clone().divideScalar(length));
      const at = (share) => points[k - 1].clone().addScaledVector(along, share);
      wanted.rod.push([new Matrix4().compose(at(0.5), turn, new Vector3(thick, length, thick)), paint]);
      if (length > 14 * thick)
        wanted.arrow.push([new Matrix4().compose(at(0.55), turn, new Vector3(thick, thick, thick)), paint]);
      if (k + 1 < points.length)
        wanted.ball.push([new Matrix4().compose(points[k], turn, new Vector3(thick, thick, thick)), paint]);
    }
  }

  fill(kind, wanted) {
    let mesh = this.meshes[kind];
    if (!mesh || mesh.instanceMatrix.count < wanted.length) {
      if (mesh) {
        this.group.remove(mesh);
        mesh.dispose();
      }
      mesh = new InstancedMesh(this.kinds[kind], this.material, Math.max(32, 2 * wanted.length));
      mesh.frustumCulled = false; // three.js computes the bounds only for the first instances
      this.meshes[kind] = mesh;
      this.group.add(mesh);
    }
    mesh.count = wanted.length;
    wanted.forEach(([matrix, paint], k) => {
      mesh.setMatrixAt(k, matrix);
      mesh.setColorAt(k, paint);
    });
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }
}

/**
 * Creates the renderer.
 * \param follows true if the scene is redrawn many times per second. Without a graphics card, antialiasing is then
 *     omitted.
 */
function rendererOf(follows) {
  const how = { antialias: true, alpha: true, preserveDrawingBuffer: true };
  if (!follows) return new WebGLRenderer(how);
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2", { ...how, failIfMajorPerformanceCaveat: true });
  return context ? new WebGLRenderer({ ...how, canvas, context }) : new WebGLRenderer({ ...how, antialias: false });
}

function webglOf(element, follows) {
  try {
    const renderer = rendererOf(follows);
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    element.append(renderer.domElement);
    return renderer;
  } catch (error) {
    return null;
  }
}

function addKeys(element, camera, controls, draw) {
  element.addEventListener("keydown", (event) => {
    const offset = camera.position.clone().sub(controls.target);
    const up = new Vector3(0, 0, 1);
    const side = new Vector3().crossVectors(up, offset).normalize();
    const turns = { ArrowLeft: [up, -0.12], ArrowRight: [up, 0.12], ArrowUp: [side, -0.12], ArrowDown: [side, 0.12] };
    if (turns[event.key]) {
      const turned = offset.clone().applyAxisAngle(...turns[event.key]);
      // A view across the pole would be upside down.
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

/** Returns the displayed paths of a scene: the path `chosen`, or all paths if `chosen` is negative. */
function pathsShown(scene, chosen) {
  return scene.paths
    .map((path, index) => ({ ...path, colour: colourOfPath(path, index) }))
    .filter((_, index) => chosen < 0 || index === chosen);
}

function stillView(element) {
  element.dataset.renderer = "svg";
  let scene = null;
  let chosen = -1;
  const draw = () => scene && drawStill(element, scene, chosen);
  return {
    draw,
    show(next, path = -1) {
      scene = next;
      chosen = path;
      draw();
    },
    choose(index) {
      chosen = index;
      draw();
    },
  };
}

class WebglView {
  constructor(element, renderer) {
    this.element = element;
    this.renderer = renderer;
    this.world = new Scene();
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(0.4, -0.7, 1);
    this.solid = new Solid();
    this.paths = new Paths();
    this.world.add(new AmbientLight(0xffffff, 1.6), sun, this.solid.group, this.paths.group);
    this.camera = new PerspectiveCamera(FIELD_DEG, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.enableZoom = false; // the wheel scrolls the page; the keys + and - zoom
    this.controls.addEventListener("change", () => this.isFraming || this.render());
    addKeys(element, this.camera, this.controls, () => this.render());
    new ResizeObserver(() => this.fit()).observe(element);
    element.dataset.renderer = "webgl";
  }

/** Adapts the distance of the camera to the size of the scene. The direction of view is kept. */
  frame(bounds) {
    this.isFraming = true;
    const from = this.size
      ? this.camera.position.clone().sub(this.controls.target).multiplyScalar(bounds.size / this.size)
      : new Vector3(0.75, -1.45, 0.55).multiplyScalar(bounds.size);
    this.size = bounds.size;
    this.controls.target.set(...bounds.middle);
    this.camera.near = 0.01 * bounds.size;
    this.camera.far = 20 * bounds.size;
    this.camera.position.copy(this.controls.target).add(from);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.isFraming = false;
  }

  show(scene, chosen = -1, bounds = boundsOf([...scene.vertices, ...scene.paths.flatMap((path) => path.points)])) {
    this.scene = scene;
    this.chosen = chosen;
    this.solid.show(scene);
    this.frame(bounds);
    this.draw();
  }

  choose(index) {
    this.chosen = index;
    this.draw();
  }

/** Draws everything in the colours of the theme. */
  draw() {
    if (!this.scene) return;
    this.solid.paint();
    this.paths.show(pathsShown(this.scene, this.chosen), this.size);
    this.render();
  }

  render() {
    this.renderer.render(this.world, this.camera);
    this.element.dataset.camera = this.camera.position.toArray().map((c) => c.toFixed(4)).join(" ");
  }

  fit() {
    const width = Math.max(200, this.element.clientWidth);
    const height = Math.max(200, this.element.clientHeight);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // In portrait orientation, the width limits the size of the part, so the field of view is enlarged.
    const half = Math.tan((FIELD_DEG * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.fov = (360 / Math.PI) * Math.atan(half);
    this.camera.updateProjectionMatrix();
    this.render();
  }
}

/**
 * Creates a view in an element, with the functions show(scene, path), choose(path) and draw().
 * \param follows true if the scene changes many times per second
 */
export function openView(element, { follows = false } = {}) {
  const renderer = webglOf(element, follows);
  if (!renderer) return stillView(element);
  const view = new WebglView(element, renderer);
  view.fit();
  return view;
}
