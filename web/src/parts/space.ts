// The robot in space, drawn by three.js. This file is a chunk of its own, loaded when asked for.
import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  GridHelper,
  Group,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

import type { Place } from '../robot';
import { palette, servoColour } from '../view/palette';
import type { Body, Model, Solid } from './model';
import { Thrift } from './thrift';

/** How far a body of lift 1 goes when all is apart, mm; as in the guide's pictures. */
const LIFT = 45;
/** A cell of the floor's grid, mm, and how many there are. */
const CELL = 50;
const CELLS = 16;
/** A finger or mouse that has moved less has clicked, CSS pixels. */
const CLICK = 5;
/** A key turns the view by so much, rad. */
const TURN = Math.PI / 24;
/** What has not changed for so long stands still, ms. */
const STILL = 400;
/** Steps of the guide before the current one, and all but a part that is picked out, are mixed so far with the floor. */
const PALE = 0.65;

/** What is to be seen. */
export interface Look {
  /** 0 to 1. */
  apart: number;
  /** The step of the guide, from 1; null for the whole robot. */
  step: number | null;
  /** The number of the body that is picked out. */
  picked: number | null;
}

export class Space {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 10, 4000);
  private readonly controls: OrbitControls;
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly thrift: Thrift;
  private grid: GridHelper | null = null;
  private model: Model | null = null;
  private mounts: Group[] = [];
  private meshes: Mesh<BufferGeometry, MeshLambertMaterial>[] = [];
  private look: Look = { apart: 0, step: null, picked: null };
  private dirty = true;
  /** When there was something new last, ms. */
  private changed = 0;

  /** Throws where the browser has no WebGL. `onPick` hears of the body that was clicked. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    onPick: (body: number | null) => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'low-power' });
    this.thrift = new Thrift(this.renderer.getContext() as WebGL2RenderingContext);
    this.camera.up.set(0, 0, 1);
    // The sun is behind whoever looks, a little to the side.
    this.sun.position.set(-0.6, 0.9, 1.2);
    this.camera.add(this.sun);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.1));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => (this.dirty = true));
    this.controls.maxDistance = 1500;
    this.controls.minDistance = 60;
    // One finger across turns the robot; along the page it scrolls, as everywhere else.
    canvas.style.touchAction = 'pan-y';
    this.listen(onPick);
    this.home();
  }

  private listen(onPick: (body: number | null) => void): void {
    const { canvas } = this;
    // Without Ctrl the wheel scrolls the page: the controls are not to hear of it.
    canvas.parentElement?.addEventListener('wheel', (event) => event.ctrlKey || event.stopPropagation(), { capture: true });
    let down: { x: number; y: number } | null = null;
    canvas.addEventListener('pointerdown', ({ offsetX: x, offsetY: y }) => (down = { x, y }));
    canvas.addEventListener('pointerup', ({ offsetX: x, offsetY: y }) => {
      if (down && Math.hypot(x - down.x, y - down.y) < CLICK) onPick(this.at(x, y));
      down = null;
    });
    canvas.addEventListener('pointercancel', () => (down = null));
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !this.key(event.key)) return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  private key(key: string): boolean {
    const ways: Record<string, [number, number, number]> = {
      ArrowLeft: [-TURN, 0, 1],
      ArrowRight: [TURN, 0, 1],
      ArrowUp: [0, TURN, 1],
      ArrowDown: [0, -TURN, 1],
      '+': [0, 0, 0.87],
      '-': [0, 0, 1.15],
      Home: [0, 0, 0],
    };
    const way = ways[key];
    if (!way) return false;
    const [about, up, closer] = way;
    if (closer === 0) this.home();
    else {
      const { target } = this.controls;
      const from = this.camera.position.clone().sub(target);
      const rise = Math.asin(Math.max(-1, Math.min(1, from.z / from.length())));
      const most = Math.PI / 2 - 0.05;
      const wanted = Math.max(-most, Math.min(most, rise + up));
      const round = Math.atan2(from.y, from.x) + about;
      const long = Math.max(this.controls.minDistance, Math.min(this.controls.maxDistance, from.length() * closer));
      this.camera.position.set(Math.cos(round) * Math.cos(wanted), Math.sin(round) * Math.cos(wanted), Math.sin(wanted));
      this.camera.position.multiplyScalar(long).add(target);
      this.controls.update();
    }
    this.dirty = true;
    return true;
  }

  /** The view from which the guide is drawn: from behind, from the left and from above. */
  home(): void {
    this.controls.target.set(0, -30, 5);
    // A narrow canvas is to show all of it, too.
    const { clientWidth, clientHeight } = this.canvas;
    const far = 500 * Math.max(1, (1.3 * clientHeight) / Math.max(1, clientWidth));
    this.camera.position.copy(new Vector3(-0.62, -0.62, 0.52).normalize().multiplyScalar(far)).add(this.controls.target);
    this.controls.update();
    this.dirty = true;
  }

  /** Takes another robot's solids. */
  take(model: Model, solids: Solid[]): void {
    for (const mount of this.mounts) this.scene.remove(mount);
    for (const mesh of this.meshes) mesh.material.dispose();
    for (const geometry of new Set(this.meshes.map((mesh) => mesh.geometry))) geometry.dispose();
    this.model = model;
    const geometries = solids.map(({ corners, triangles }) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(corners, 3));
      geometry.setIndex(new BufferAttribute(triangles, 1));
      geometry.computeBoundingSphere();
      return geometry;
    });
    this.mounts = Array.from({ length: model.mounts }, () => {
      const mount = new Group();
      mount.matrixAutoUpdate = false;
      this.scene.add(mount);
      return mount;
    });
    this.meshes = model.bodies.map((body) => {
      const mesh = new Mesh(geometries[body.solid], new MeshLambertMaterial({ flatShading: true }));
      mesh.matrixAutoUpdate = false;
      this.mounts[body.mount]?.add(mesh);
      return mesh;
    });
    this.show(this.look);
  }

  /** Shows it so; also after light has become dark. */
  show(look: Look): void {
    this.look = look;
    const { step, apart, picked } = look;
    const colours = palette();
    const floor = new Color(colours.floor);
    this.scene.background = floor;
    if (this.grid) this.scene.remove(this.grid);
    this.grid?.dispose();
    this.grid = new GridHelper(CELL * CELLS, CELLS, colours.grid, colours.grid);
    this.grid.geometry.rotateX(Math.PI / 2);
    this.grid.matrixAutoUpdate = false;
    this.scene.add(this.grid);
    this.model?.bodies.forEach((body, number) => {
      const mesh = this.meshes[number];
      if (!mesh) return;
      const isNew = step === null || body.step === step;
      mesh.visible = step === null || body.step <= step;
      const isPale = picked === null ? !isNew : number !== picked;
      mesh.material.color.set(colour(body)).lerp(floor, isPale ? PALE : 0);
      const lift = new Matrix4().makeTranslation(0, 0, isNew ? apart * LIFT * body.lift : 0);
      mesh.matrix.copy(lift.multiply(new Matrix4().fromArray(body.place)));
      mesh.matrixWorldNeedsUpdate = true;
    });
    this.dirty = true;
  }

  /** Puts every mount where it is: x, y, cosine and sine each. */
  pose(places: Float64Array): void {
    this.mounts.forEach((mount, number) => {
      const [x = 0, y = 0, cos = 1, sin = 0] = places.subarray(4 * number, 4 * number + 4);
      mount.matrix.set(cos, -sin, 0, x, sin, cos, 0, y, 0, 0, 1, 0, 0, 0, 0, 1);
      mount.matrixWorldNeedsUpdate = true;
    });
    this.dirty = true;
  }

  /** Whether the picture before is paid for; to be asked in every picture of the page, seen or not. */
  mayDraw(): boolean {
    return this.thrift.may();
  }

  /** Draws a picture if there is something new and the picture before is paid for. `place` is the body's on the floor. */
  draw(place: Place): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.mayDraw() || width === 0 || height === 0) return;
    const now = performance.now();
    if (this.dirty) this.changed = now;
    // What stands still is painted once more with all its points.
    const still = now - this.changed > STILL;
    const ratio = Math.min(2, devicePixelRatio) * (still ? 1 : this.thrift.sharpness);
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.dirty = true;
    }
    if (!this.dirty) return;
    this.dirty = false;
    this.ground(place);
    this.renderer.render(this.scene, this.camera);
    this.thrift.drawn(still);
  }

  /** The robot stays in the middle, and the floor moves below it. */
  private ground({ x, y, heading }: Place): void {
    if (!this.grid) return;
    const turn = new Matrix4().makeRotationZ((-heading * Math.PI) / 180);
    const rest = (value: number) => value - CELL * Math.round(value / CELL);
    const depth = this.look.step === null ? -(this.model?.floor ?? 0) : -2 * (this.model?.floor ?? 0);
    const shift = new Matrix4().makeTranslation(-rest(x), -rest(y), depth);
    this.grid.matrix.copy(turn.multiply(shift));
    this.grid.matrixWorldNeedsUpdate = true;
  }

  /** The body that is seen there, CSS pixels of the canvas. */
  private at(x: number, y: number): number | null {
    const { clientWidth, clientHeight } = this.canvas;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    const seen = this.meshes.filter((mesh) => mesh.visible);
    const first = ray.intersectObjects(seen, false)[0];
    return first ? this.meshes.indexOf(first.object as (typeof this.meshes)[number]) : null;
  }
}

/** Printed parts have the colour of their servo, as in the drawing; what is bought that of its material. */
function colour({ kind, servo }: Body): string {
  const { 'skin-edge': plate, tube, steel } = palette();
  switch (kind) {
    case 'printed':
      return servo === null ? plate : servoColour(servo);
    case 'servo':
      return '#4a6fa5';
    case 'board':
      return '#1d7f86';
    case 'battery':
      return '#b58a2a';
    case 'pad':
    case 'lead':
      return '#4b4b4b';
    case 'horn':
      return '#efefe8';
    case 'fitting':
      return '#8a6d4b';
    case 'standoff':
      return tube;
    default:
      return steel;
  }
}
