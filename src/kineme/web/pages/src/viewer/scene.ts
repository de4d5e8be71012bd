/** Update the 3-D scene from the page's state. */
import * as THREE from "three";
import { NO_COLOR, adaptColor } from "../colors";
import type { Segment } from "../messages";
import { computePose, createPose, findRoot, getHeading, type Motion } from "../motion";
import { formatPerson } from "../recordingData";
import { findPrimitiveAt } from "../segments";
import type { Store } from "../store";
import { readColor, theme } from "../drawing";
import {
  getAnatomy,
  getFigureTime,
  isFree,
  movePose,
  placeInStep,
  placeSideBySide,
  type PlacedFigure,
} from "./placement";
import { Figure, Ghost, Trails } from "./figure";
import { Stage } from "./stage";

const TRAIL_LENGTH = 1.2; // seconds
const CATCH_UP = 3; // rate per second at which the camera follows during playback

/** A name and its position (bottom centre), as shares of the canvas. */
export interface Tag {
  name: string;
  x: number;
  y: number;
  /** Whether edits apply to this person. */
  isActive: boolean;
}

export class FigureScene {
  readonly stage: Stage;
  private placed: PlacedFigure[] = [];
  private figures: Figure[] = [];
  private trails: Trails | null = null;
  private poses: Float32Array[] = [];
  private contentKey = "";
  private size = 1;
  private readonly ghost: Ghost;

  constructor(
    private readonly store: Store,
    canvas: HTMLCanvasElement,
  ) {
    this.stage = new Stage(canvas);
    this.ghost = new Ghost(this.stage.scene, this.stage.fog);
  }

  /** Create the figures; needed when recordings, cluster or members change. */
  populate(): void {
    this.clear();
    this.placed = this.placeFigures();
    this.figures = this.placed.map(
      ({ motion }) => new Figure(this.stage.fog, motion.head, getAnatomy(motion)),
    );
    this.poses = this.placed.map(({ motion }) => createPose(motion));
    for (const figure of this.figures) this.stage.scene.add(figure.group);
    const lead = this.placed[0];
    if (!lead) return;
    const paths = this.placed.reduce((sum, each) => sum + listEndJoints(each.motion).length, 0);
    if (!lead.segment && paths > 0) {
      this.trails = new Trails(this.stage.fog, paths, 0.022 * this.size);
      this.stage.scene.add(this.trails.mesh);
    }
    const { id, file } = this.store.recording.value!;
    const of = this.store.people.value.length ? file : id;
    const scene = `${this.placed.length} ${lead.segment !== null} ${of}`;
    if (scene !== this.contentKey) this.frameFigures();
    this.contentKey = scene;
  }

  /** Pose all figures for the playhead; `seconds` since the last frame. */
  setPoses(seconds: number): void {
    const { store } = this;
    const leader = this.findLeader();
    const shadow = readColor("shadow");
    const [body, joint] = [readColor("body"), readColor("joint")];
    this.placed.forEach((each, i) => {
      const pose = this.poses[i]!;
      this.placePose(each, getFigureTime(each, store.playhead.value, leader), pose);
      this.figures[i]!.setPose(pose);
      const color = this.getColorAt(each, store.playhead.value);
      const leads = each.segment !== null && each.segment === leader;
      const joints = each.segment ? joint : color;
      const colors = leads ? { body: color, joint: color } : { body, joint: joints };
      this.figures[i]!.setColors({ ...colors, shadow });
    });
    const lead = this.placed[0];
    const free = this.placed.length === 1 && lead?.segment === null;
    const ghost = free ? store.ghost.value : null;
    if (lead) this.ghost.show(lead.motion, ghost, store.present.value, store.playhead.value);
    this.drawTrails();
    if (store.follow.value) this.followLead(seconds);
  }

  /** Move the camera so that all figures are visible. */
  frameFigures(): void {
    const lead = this.placed[0];
    if (!lead) return;
    const { playhead } = this.store;
    const leader = this.findLeader();
    this.placed.forEach((each, i) =>
      this.placePose(each, getFigureTime(each, playhead.value, leader), this.poses[i]!),
    );
    const { ground } = getAnatomy(lead.motion);
    const alone = this.placed.length === 1;
    if (!alone && this.placed.every(isFree)) return this.frameTogether(ground);
    const slots = this.placed.map((each) => each.placement.slot);
    const width = Math.max(...slots.map(([x]) => x)) - Math.min(...slots.map(([x]) => x));
    const depth = Math.max(...slots.map(([, z]) => z)) - Math.min(...slots.map(([, z]) => z));
    const [x, z] = alone ? this.getMiddle() : [0, 0];
    const side = alone ? getHeading(lead.motion, this.store.playhead.value) + 0.6 : 0.12;
    const target = new THREE.Vector3(x, ground + 0.5 * this.size, z);
    const height = (1.3 + 0.5 * (depth / this.size)) * this.size;
    this.stage.lookAt(target, side, width + 1.25 * this.size, height, depth > 0 ? 0.5 : 0.22);
  }

  /** Move the camera so that people do not hide each other. */
  private frameTogether(ground: number): void {
    const roots = this.getRootPositions();
    const [x, z] = this.getMiddle();
    const [axisX, axisZ] = findLongestDistance(roots);
    const apart = Math.hypot(axisX, axisZ);
    const usual = getHeading(this.placed[0]!.motion, this.store.playhead.value) + 0.6;
    const across = Math.atan2(-axisZ, axisX) + 0.15;
    const side = Math.cos(across - usual) < 0 ? across + Math.PI : across;
    const target = new THREE.Vector3(x, ground + 0.5 * this.size, z);
    const isApart = apart > 0.3 * this.size;
    this.stage.lookAt(target, isApart ? side : usual, apart + 1.25 * this.size, 1.4 * this.size);
  }

  /** Return the name tags of several people. */
  getNameTags(): Tag[] {
    const { store } = this;
    if (!store.people.value.length || store.inStep.value) return [];
    return this.placed.flatMap((each, i) => {
      const at = new THREE.Vector3().fromArray(this.poses[i]!, 3 * findRoot(each.motion.head));
      at.setY(findHighest(this.poses[i]!) + 0.06 * this.size).project(this.stage.camera);
      if (Number.isNaN(at.x) || Math.abs(at.z) > 1) return [];
      const isActive = each.motion === store.active.value?.motion.value;
      return [{ name: each.name, x: (1 + at.x) / 2, y: (1 - at.y) / 2, isActive }];
    });
  }

  /** Return the figure nearest to a point of the canvas (-1 to 1, y up). */
  pick(x: number, y: number): PlacedFigure | undefined {
    const near = this.placed.map((each, i) => {
      const root = 3 * findRoot(each.motion.head);
      const at = new THREE.Vector3().fromArray(this.poses[i]!, root).project(this.stage.camera);
      return { each, far: Math.hypot((at.x - x) * this.stage.camera.aspect, at.y - y) };
    });
    return near.sort((a, b) => a.far - b.far).find(({ far }) => far < 0.3)?.each;
  }

  dispose(): void {
    this.clear();
    this.stage.dispose();
  }

  private placeFigures(): PlacedFigure[] {
    const { store } = this;
    const motion = store.active.value?.motion.value;
    const members = store.shownCluster.value?.members ?? [];
    const shown = store.opened.value.flatMap((opened) => {
      const { name, file, person } = opened.recording.value;
      const { value: motion } = opened.motion;
      return motion ? [{ motion, name: formatPerson(person ?? name), file }] : [];
    });
    this.size = Math.max(...shown.map((each) => getAnatomy(each.motion).size), 0) || 1;
    const ground = Math.min(...shown.map((each) => getAnatomy(each.motion).ground));
    if (shown.length > 0) this.stage.fit(this.size, ground);
    if (store.inStep.value && motion && members.length > 0)
      return placeInStep(motion, members, this.size);
    return placeSideBySide(shown, this.size);
  }

  /** Return the member at the playhead, else the selected one; the others keep step with it. */
  private findLeader(): Segment | undefined {
    const frame = this.store.frame.value;
    const members = this.placed.flatMap(({ segment }) => (segment ? [segment] : []));
    const selected = this.store.selected.value;
    return (
      members.find((each) => each.start_frame <= frame && frame < each.stop_frame) ??
      members.find((each) => each.start_frame === selected?.start_frame)
    );
  }

  private placePose(placed: PlacedFigure, time: number, pose: Float32Array): void {
    computePose(placed.motion, time, pose);
    movePose(pose, placed.placement, findRoot(placed.motion.head));
  }

  /** Return the root positions (x, z) of all figures. */
  private getRootPositions(): [number, number][] {
    return this.placed
      .map(({ motion }, i): [number, number] => {
        const root = 3 * findRoot(motion.head);
        return [this.poses[i]![root]!, this.poses[i]![root + 2]!];
      })
      .filter(([x, z]) => !Number.isNaN(x + z));
  }

  /** Return the centre of the figures (x, z). */
  private getMiddle(): [number, number] {
    const roots = this.getRootPositions();
    const getMidpoint = (values: number[]): number =>
      values.length ? (Math.min(...values) + Math.max(...values)) / 2 : 0;
    return [getMidpoint(roots.map(([x]) => x)), getMidpoint(roots.map(([, z]) => z))];
  }

  private followLead(seconds: number): void {
    if (!this.placed.length || !this.placed.every(isFree)) return;
    const [x, z] = this.getMiddle();
    const { target } = this.stage.controls;
    const share = this.store.playing.value ? 1 - Math.exp(-CATCH_UP * seconds) : 1;
    this.stage.moveTo(target.x + share * (x - target.x), target.z + share * (z - target.z));
  }

  /** Return the colour of the primitive of a figure's recording at a time (seconds). */
  private getColorAt({ motion }: PlacedFigure, time: number): string {
    const { opened, active } = this.store;
    const shown = opened.value.find((each) => each.motion.value === motion) ?? active.value;
    const segment = shown && findPrimitiveAt(shown.recording.value.segmentation, time);
    return adaptColor((segment && this.store.getColor(segment)) ?? NO_COLOR, theme.value);
  }

  private drawTrails(): void {
    if (!this.trails) return;
    const { playhead } = this.store;
    this.trails.mesh.visible = this.store.trails.value && playhead.value > 0;
    if (!this.trails.mesh.visible) return;
    const times = Trails.listTimes(playhead.value, TRAIL_LENGTH);
    const paths = this.placed.map((each) => this.computePaths(each, times));
    const colors = this.placed.flatMap((each, i) => {
      const ofTimes = times.map((time) => new THREE.Color(this.getColorAt(each, time)));
      return paths[i]!.map(() => ofTimes);
    });
    this.trails.draw(paths.flat(), colors, this.stage.camera.position);
  }

  private computePaths(placed: PlacedFigure, times: readonly number[]): Float32Array[] {
    const joints = listEndJoints(placed.motion);
    const paths = joints.map(() => new Float32Array(3 * times.length));
    const pose = createPose(placed.motion);
    times.forEach((time, i) => {
      this.placePose(placed, time, pose);
      joints.forEach((joint, k) => paths[k]!.set(pose.subarray(3 * joint, 3 * joint + 3), 3 * i));
    });
    return paths;
  }

  private clear(): void {
    this.ghost.clear();
    for (const figure of this.figures) {
      figure.group.removeFromParent();
      figure.dispose();
    }
    this.trails?.mesh.removeFromParent();
    this.trails?.dispose();
    this.trails = null;
  }
}

/** Return the height of the highest joint. */
function findHighest(pose: Float32Array): number {
  let top = -Infinity;
  for (let i = 1; i < pose.length; i += 3) if (pose[i]! > top) top = pose[i]!;
  return top;
}

/** Return the vector between the two figures that are farthest apart. */
function findLongestDistance(roots: readonly [number, number][]): [number, number] {
  const pairs = roots.flatMap(([x, z], i) =>
    roots.slice(i + 1).map((other): [number, number] => [other[0] - x, other[1] - z]),
  );
  return pairs.sort((a, b) => Math.hypot(...b) - Math.hypot(...a))[0] ?? [0, 0];
}

function listEndJoints(motion: Motion): number[] {
  const { effectors } = motion.head;
  return Object.keys(effectors)
    .filter((part) => part !== "head")
    .map((part) => effectors[part]!);
}
