// The robot in 3D, rendered by three.js. This file is a separate chunk, which is loaded on demand.
import * as three from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

import type { Place } from '../robot';
import { getPalette, getServoColour } from '../view/palette';
import type { BodyEntry } from '../../generated/parts';
import type { Model, Solid } from './make-parts';
import { RenderBudget } from './render-budget';

/** Lift of a body with `lift` 1 in the fully exploded view, mm, as in the guide's pictures. */
const LIFT_MM = 45;
/** Cell size of the floor's grid, mm. */
const GRID_CELL_MM = 50;
const GRID_CELLS_PER_SIDE = 16;
/** Largest movement of the pointer during a click, CSS pixels. */
const MAX_CLICK_MOVEMENT_PX = 5;
/** Rotation of the view per key press, rad. */
const KEY_ROTATION_RAD = Math.PI / 24;
/** Time after the last change at which the view counts as still, ms. */
const STILL_AFTER_MS = 400;
/** Fraction of the floor's colour in pale bodies: bodies of earlier steps, or all bodies that are not highlighted. */
const PALE_FRACTION = 0.65;

/** The settings of the 3D view: the spread of the exploded view, the guide's step and the highlighted bodies. */
export interface ViewSettings {
  /** Spread of the exploded view, 0 to 1. */
  explosion: number;
  /** The step of the guide, from 1; null for the whole robot. */
  guideStep: number | null;
  /** Index of the selected body; null for none. */
  selectedBody: number | null;
  /** Indices of the two bodies that overlap or come too close; empty if all bodies fit. */
  collidingBodies: number[];
}

/** A 3D view of the robot, which the user can rotate, zoom and click. */
export class RobotView {
  private readonly renderer: three.WebGLRenderer;
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(35, 1, 10, 4000);
  private readonly controls: OrbitControls;
  private readonly sun = new three.DirectionalLight(0xffffff, 2.2);
  readonly renderBudget: RenderBudget;
  private grid: three.GridHelper | null = null;
  private model: Model | null = null;
  private mounts: three.Group[] = [];
  private meshes: three.Mesh<three.BufferGeometry, three.MeshLambertMaterial>[] = [];
  private settings: ViewSettings = { explosion: 0, guideStep: null, selectedBody: null, collidingBodies: [] };
  private needsRendering = true;
  /** Time of the last change, ms. */
  private changedAt = 0;

  /** Throws if the browser has no WebGL. `onPick` receives the index of the clicked body, or null. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    onPick: (body: number | null) => void,
  ) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: true, powerPreference: 'low-power' });
    this.renderBudget = new RenderBudget(this.renderer.getContext() as WebGL2RenderingContext);
    this.camera.up.set(0, 0, 1);
    // The sun shines from the camera: these millimetres, in the camera's axes, hardly change its direction.
    this.sun.position.set(-0.6, 0.9, 1.2);
    this.camera.add(this.sun);
    this.scene.add(this.camera, new three.AmbientLight(0xffffff, 1.1));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => (this.needsRendering = true));
    this.controls.maxDistance = 1500;
    this.controls.minDistance = 60;
    // A horizontal drag with one finger turns the robot; a vertical drag scrolls the page.
    canvas.style.touchAction = 'pan-y';
    this.addListeners(onPick);
    this.resetView();
  }

  private addListeners(onPick: (body: number | null) => void): void {
    const { canvas } = this;
    // Without Ctrl, the wheel scrolls the page; the controls must not receive it.
    canvas.parentElement?.addEventListener('wheel', (event) => event.ctrlKey || event.stopPropagation(), { capture: true });
    let pressed: { x: number; y: number } | null = null;
    canvas.addEventListener('pointerdown', ({ offsetX: x, offsetY: y }) => (pressed = { x, y }));
    canvas.addEventListener('pointerup', ({ offsetX: x, offsetY: y }) => {
      if (pressed && Math.hypot(x - pressed.x, y - pressed.y) < MAX_CLICK_MOVEMENT_PX) onPick(this.findBody(x, y));
      pressed = null;
    });
    canvas.addEventListener('pointercancel', () => (pressed = null));
    canvas.addEventListener('keydown', (event) => {
      if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || !this.handleKey(event.key)) return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** Rotates, zooms or resets the view, depending on the key; returns false if the key has no effect. */
  handleKey(key: string): boolean {
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.moveCamera(-KEY_ROTATION_RAD, 0, 1),
      ArrowRight: () => this.moveCamera(KEY_ROTATION_RAD, 0, 1),
      ArrowUp: () => this.moveCamera(0, KEY_ROTATION_RAD, 1),
      ArrowDown: () => this.moveCamera(0, -KEY_ROTATION_RAD, 1),
      '+': () => this.moveCamera(0, 0, 0.87),
      '-': () => this.moveCamera(0, 0, 1.15),
      Home: () => this.resetView(),
    };
    actions[key]?.();
    return key in actions;
  }

  /** Changes the camera's azimuth and elevation, rad, and multiplies its distance by a factor. */
  private moveCamera(azimuthChange: number, elevationChange: number, distanceFactor: number): void {
    const { target, minDistance, maxDistance } = this.controls;
    const offset = this.camera.position.clone().sub(target);
    const elevation = Math.asin(Math.max(-1, Math.min(1, offset.z / offset.length())));
    const maxElevation = Math.PI / 2 - 0.05;
    const newElevation = Math.max(-maxElevation, Math.min(maxElevation, elevation + elevationChange));
    const newAzimuth = Math.atan2(offset.y, offset.x) + azimuthChange;
    const distance = Math.max(minDistance, Math.min(maxDistance, offset.length() * distanceFactor));
    this.camera.position.set(Math.cos(newAzimuth) * Math.cos(newElevation), Math.sin(newAzimuth) * Math.cos(newElevation), Math.sin(newElevation));
    this.camera.position.multiplyScalar(distance).add(target);
    this.controls.update();
    this.needsRendering = true;
  }

  /** Resets the camera to the guide's view: from behind, from the left and from above. */
  private resetView(): void {
    this.controls.target.set(0, -30, 5);
    // The camera is farther away for a narrow canvas, to show the whole robot.
    const { clientWidth, clientHeight } = this.canvas;
    const distance = 500 * Math.max(1, (1.3 * clientHeight) / Math.max(1, clientWidth));
    this.camera.position.copy(new three.Vector3(-0.62, -0.62, 0.52).normalize().multiplyScalar(distance)).add(this.controls.target);
    this.controls.update();
    this.needsRendering = true;
  }

  /** Replaces the shown robot with another model and its solids. */
  showModel(model: Model, solids: Solid[]): void {
    for (const mount of this.mounts) this.scene.remove(mount);
    for (const mesh of this.meshes) mesh.material.dispose();
    for (const geometry of new Set(this.meshes.map((mesh) => mesh.geometry))) geometry.dispose();
    this.model = model;
    const geometries = solids.map(({ corners, triangles }) => {
      const geometry = new three.BufferGeometry();
      geometry.setAttribute('position', new three.BufferAttribute(corners, 3));
      geometry.setIndex(new three.BufferAttribute(triangles, 1));
      geometry.computeBoundingSphere();
      return geometry;
    });
    this.mounts = Array.from({ length: model.mount_count }, () => {
      const mount = new three.Group();
      mount.matrixAutoUpdate = false;
      this.scene.add(mount);
      return mount;
    });
    this.meshes = model.bodies.map((body) => {
      const mesh = new three.Mesh(geometries[body.solid], new three.MeshLambertMaterial({ flatShading: true }));
      mesh.matrixAutoUpdate = false;
      this.mounts[body.mount]?.add(mesh);
      return mesh;
    });
    this.applySettings(this.settings);
  }

  /** Applies the view's settings and the colours of the current colour scheme. */
  applySettings(settings: ViewSettings): void {
    this.settings = settings;
    const { guideStep, explosion, selectedBody, collidingBodies } = settings;
    const colours = getPalette();
    const floor = new three.Color(colours.floor);
    this.scene.background = floor;
    if (this.grid) this.scene.remove(this.grid);
    this.grid?.dispose();
    this.grid = new three.GridHelper(GRID_CELL_MM * GRID_CELLS_PER_SIDE, GRID_CELLS_PER_SIDE, colours.grid, colours.grid);
    this.grid.geometry.rotateX(Math.PI / 2);
    this.grid.matrixAutoUpdate = false;
    this.scene.add(this.grid);
    this.model?.bodies.forEach((body, index) => {
      const mesh = this.meshes[index];
      const isInCurrentStep = guideStep === null || body.step === guideStep;
      mesh.visible = guideStep === null || body.step <= guideStep;
      const highlightedBodies = collidingBodies.length > 0 ? collidingBodies : selectedBody === null ? null : [selectedBody];
      const isPale = highlightedBodies ? !highlightedBodies.includes(index) : !isInCurrentStep;
      mesh.material.color.set(collidingBodies.includes(index) ? colours.alarm : chooseColour(body)).lerp(floor, isPale ? PALE_FRACTION : 0);
      const lift = new three.Matrix4().makeTranslation(0, 0, isInCurrentStep ? explosion * LIFT_MM * body.lift : 0);
      mesh.matrix.copy(lift.multiply(new three.Matrix4().fromArray(body.matrix)));
      mesh.matrixWorldNeedsUpdate = true;
    });
    this.needsRendering = true;
  }

  /** Places every mount; `mountPlaces` has four numbers per mount: x and y in mm, cosine and sine of the angle. */
  placeMounts(mountPlaces: Float64Array): void {
    this.mounts.forEach((mount, index) => {
      const [x = 0, y = 0, cos = 1, sin = 0] = mountPlaces.subarray(4 * index, 4 * index + 4);
      mount.matrix.set(cos, -sin, 0, x, sin, cos, 0, y, 0, 0, 1, 0, 0, 0, 0, 1);
      mount.matrixWorldNeedsUpdate = true;
    });
    this.needsRendering = true;
  }

  /** Renders a frame if the view has changed and the budget allows it. `place` is the robot's place on the floor. */
  render(place: Place): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.renderBudget.mayRender() || width === 0 || height === 0) return;
    const now = performance.now();
    if (this.needsRendering) this.changedAt = now;
    // A still view is rendered again at full resolution.
    const isStill = now - this.changedAt > STILL_AFTER_MS;
    const ratio = Math.min(2, devicePixelRatio) * (isStill ? 1 : this.renderBudget.resolution);
    const size = this.renderer.getSize(new three.Vector2());
    if (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.needsRendering = true;
    }
    if (!this.needsRendering) return;
    this.needsRendering = false;
    this.moveGrid(place);
    this.renderer.render(this.scene, this.camera);
    this.renderBudget.recordFrame(isStill);
  }

  /** Moves the floor's grid under the robot, so that the robot stays in the middle of the view. */
  private moveGrid({ x, y, heading }: Place): void {
    if (!this.grid) return;
    const rotation = new three.Matrix4().makeRotationZ((-heading * Math.PI) / 180);
    const wrapToCell = (value: number) => value - GRID_CELL_MM * Math.round(value / GRID_CELL_MM);
    const floorZ = this.settings.guideStep === null ? -(this.model?.sole_depth ?? 0) : -2 * (this.model?.sole_depth ?? 0);
    const translation = new three.Matrix4().makeTranslation(-wrapToCell(x), -wrapToCell(y), floorZ);
    this.grid.matrix.copy(rotation.multiply(translation));
    this.grid.matrixWorldNeedsUpdate = true;
  }

  /** Returns the index of the foremost body at a point of the canvas, CSS pixels; null if no body is there. */
  private findBody(x: number, y: number): number | null {
    const { clientWidth, clientHeight } = this.canvas;
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    const visibleMeshes = this.meshes.filter((mesh) => mesh.visible);
    const hit = ray.intersectObjects(visibleMeshes, false)[0];
    return hit ? this.meshes.indexOf(hit.object as (typeof this.meshes)[number]) : null;
  }
}

/** The colours of bought bodies by kind. A standoff has the tubes' colour; all other kinds have the colour of steel. */
const KIND_COLOURS: Partial<Record<BodyEntry['kind'], string>> = {
  servo: '#4a6fa5',
  board: '#1d7f86',
  battery: '#b58a2a',
  pad: '#4b4b4b',
  lead: '#4b4b4b',
  horn: '#efefe8',
  fitting: '#8a6d4b',
};

/**
 * Returns a body's colour. A printed part has the colour of its servo or, without a servo, of the plate; any other body
 * has that of its kind.
 */
function chooseColour({ kind, servo }: BodyEntry): string {
  const { 'skin-edge': plate, tube, steel } = getPalette();
  if (kind === 'printed') return servo === null ? plate : getServoColour(servo);
  return KIND_COLOURS[kind] ?? (kind === 'standoff' ? tube : steel);
}
