/** Brings the state of the page into the picture: which figure where, in which pose and colour. */
import * as THREE from "three";
import { NO_COLOR, onPage } from "../colors";
import type { Segment } from "../messages";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";
import { personCalled } from "../opened";
import { primitiveAt } from "../segments";
import type { Store } from "../store";
import { cssColor, theme } from "../theme";
import { anatomyOfCached } from "./anatomy";
import { inStep, isFree, timeOf, putInPlace, sideBySide, type PlacedFigure } from "./placement";
import { Figure } from "./figure";
import { Ghost } from "./ghost";
import type { Tag } from "./nameTags";
import { Stage } from "./stage";
import { Trails } from "./trails";

const TRAIL_LENGTH = 1.2; // seconds
const CATCH_UP = 3; // per second: how fast the camera follows while playing

export class FigureScene {
  readonly stage: Stage;
  private placed: PlacedFigure[] = [];
  private figures: Figure[] = [];
  private trails: Trails | null = null;
  private poses: Float32Array[] = [];
  private scene = "";
  private size = 1;
  private readonly ghost: Ghost;

  constructor(
    private readonly store: Store,
    canvas: HTMLCanvasElement,
  ) {
    this.stage = new Stage(canvas);
    this.ghost = new Ghost(this.stage.scene, this.stage.haze);
  }

  /** New figures when the recordings, the cluster or its members changed. */
  populate(): void {
    this.clear();
    this.placed = this.choosePlaced();
    this.figures = this.placed.map(
      ({ motion }) => new Figure(this.stage.haze, motion.head, anatomyOfCached(motion)),
    );
    this.poses = this.placed.map(({ motion }) => new Float32Array(motion.head.joints.length * 3));
    for (const figure of this.figures) this.stage.scene.add(figure.group);
    const lead = this.placed[0];
    if (!lead) return;
    const paths = this.placed.reduce((sum, each) => sum + handsAndFeet(each.motion).length, 0);
    if (!lead.segment && paths > 0) {
      this.trails = new Trails(this.stage.haze, paths, 0.022 * this.size);
      this.stage.scene.add(this.trails.mesh);
    }
    const { id, file } = this.store.recording.value!;
    const of = this.store.people.value.length ? file : id;
    const scene = `${this.placed.length} ${lead.segment !== null} ${of}`;
    if (scene !== this.scene) this.frame();
    this.scene = scene;
  }

  paint(): void {
    this.stage.paint({ sky: cssColor("sky"), ground: cssColor("ground"), grid: cssColor("grid") });
  }

  /** Poses every figure for the playhead. */
  pose(seconds: number): void {
    const { store } = this;
    const leader = this.leader();
    const shadow = cssColor("shadow");
    const [body, joint] = [cssColor("body"), cssColor("joint")];
    this.placed.forEach((each, i) => {
      const pose = this.poses[i]!;
      this.placedPose(each, timeOf(each, store.playhead.value, leader), pose);
      this.figures[i]!.pose(pose);
      const color = onPage(this.colorOf(this.presentOf(each, store.playhead.value)), theme.value);
      const leads = each.segment !== null && each.segment === leader;
      const joints = each.segment ? joint : color;
      this.figures[i]!.paint({ body: leads ? color : body, joint: leads ? color : joints, shadow });
    });
    const lead = this.placed[0];
    const free = this.placed.length === 1 && lead?.segment === null;
    if (lead)
      this.ghost.show(
        lead.motion,
        free ? store.ghost.value : null,
        store.present.value,
        store.playhead.value,
      );
    this.drawTrails();
    if (store.follow.value) this.followLead(seconds);
  }

  /** Puts the camera where all figures are seen. */
  frame(): void {
    const lead = this.placed[0];
    if (!lead) return;
    this.placed.forEach((each, i) => {
      this.placedPose(each, timeOf(each, this.store.playhead.value, this.leader()), this.poses[i]!);
    });
    const { ground } = anatomyOfCached(lead.motion);
    const alone = this.placed.length === 1;
    if (!alone && this.placed.every(isFree)) return this.frameTogether(ground);
    const slots = this.placed.map((each) => each.place.slot);
    const width = Math.max(...slots.map(([x]) => x)) - Math.min(...slots.map(([x]) => x));
    const depth = Math.max(...slots.map(([, z]) => z)) - Math.min(...slots.map(([, z]) => z));
    const [x, z] = alone ? this.middle() : [0, 0];
    const side = alone ? headingAt(lead.motion, this.store.playhead.value) + 0.6 : 0.12;
    const target = new THREE.Vector3(x, ground + 0.5 * this.size, z);
    const height = (1.3 + 0.5 * (depth / this.size)) * this.size;
    this.stage.look(target, side, width + 1.25 * this.size, height, depth > 0 ? 0.5 : 0.22);
  }

  /** People who share their space: all are seen, from the side where none hides another. */
  private frameTogether(ground: number): void {
    const roots = this.roots();
    const [x, z] = this.middle();
    const [axisX, axisZ] = longest(roots);
    const apart = Math.hypot(axisX, axisZ);
    const usual = headingAt(this.placed[0]!.motion, this.store.playhead.value) + 0.6;
    const across = Math.atan2(-axisZ, axisX) + 0.15;
    const side = Math.cos(across - usual) < 0 ? across + Math.PI : across;
    const target = new THREE.Vector3(x, ground + 0.5 * this.size, z);
    const isApart = apart > 0.3 * this.size;
    this.stage.look(target, isApart ? side : usual, apart + 1.25 * this.size, 1.4 * this.size);
  }

  /** Over whose heads the names of several people stand. */
  tags(): Tag[] {
    const { store } = this;
    if (!store.people.value.length || store.inStep.value) return [];
    return this.placed.flatMap((each, i) => {
      const at = new THREE.Vector3().fromArray(this.poses[i]!, 3 * rootOf(each.motion.head));
      at.y = highest(this.poses[i]!) + 0.06 * this.size;
      at.project(this.stage.camera);
      if (Number.isNaN(at.x) || Math.abs(at.z) > 1) return [];
      const front = each.motion === store.active.value?.motion.value;
      return [{ name: each.name, x: (1 + at.x) / 2, y: (1 - at.y) / 2, front }];
    });
  }

  /** The figure nearest to a point of the canvas (from -1 to 1, y up). */
  pick(x: number, y: number): PlacedFigure | undefined {
    const near = this.placed.map((each, i) => {
      const root = 3 * rootOf(each.motion.head);
      const at = new THREE.Vector3().fromArray(this.poses[i]!, root).project(this.stage.camera);
      return { each, far: Math.hypot((at.x - x) * this.stage.camera.aspect, at.y - y) };
    });
    return near.sort((a, b) => a.far - b.far).find(({ far }) => far < 0.3)?.each;
  }

  dispose(): void {
    this.clear();
    this.stage.dispose();
  }

  private choosePlaced(): PlacedFigure[] {
    const { store } = this;
    const motion = store.active.value?.motion.value;
    const members = store.shownCluster.value?.members ?? [];
    const shown = store.opened.value.flatMap((opened) => {
      const { name, file, person } = opened.recording.value;
      const { value: motion } = opened.motion;
      return motion ? [{ motion, name: personCalled(person ?? name), file }] : [];
    });
    this.size = Math.max(...shown.map((each) => anatomyOfCached(each.motion).size), 0) || 1;
    const ground = Math.min(...shown.map((each) => anatomyOfCached(each.motion).ground));
    if (shown.length > 0) this.stage.fit(this.size, ground);
    if (store.inStep.value && motion && members.length > 0)
      return inStep(motion, members, this.size);
    return sideBySide(shown, this.size);
  }

  /** The member under the playhead, else the selected one: it sets the pace. */
  private leader(): Segment | undefined {
    const frame = this.store.frame.value;
    const members = this.placed.flatMap(({ segment }) => (segment ? [segment] : []));
    const selected = this.store.selected.value;
    return (
      members.find((each) => each.start_frame <= frame && frame < each.stop_frame) ??
      members.find((each) => each.start_frame === selected?.start_frame)
    );
  }

  private placedPose(placed: PlacedFigure, time: number, pose: Float32Array): void {
    poseAt(placed.motion, time, pose);
    putInPlace(pose, placed.place, rootOf(placed.motion.head));
  }

  /** Where those stand (x, z) who are in the picture. */
  private roots(): [number, number][] {
    return this.placed
      .map(({ motion }, i): [number, number] => {
        const root = 3 * rootOf(motion.head);
        return [this.poses[i]![root]!, this.poses[i]![root + 2]!];
      })
      .filter(([x, z]) => !Number.isNaN(x + z));
  }

  /** In the middle of them. */
  private middle(): [number, number] {
    const roots = this.roots();
    const between = (values: number[]): number =>
      values.length ? (Math.min(...values) + Math.max(...values)) / 2 : 0;
    return [between(roots.map(([x]) => x)), between(roots.map(([, z]) => z))];
  }

  private followLead(seconds: number): void {
    if (!this.placed.length || !this.placed.every(isFree)) return;
    const [x, z] = this.middle();
    const { target } = this.stage.controls;
    const share = this.store.playing.value ? 1 - Math.exp(-CATCH_UP * seconds) : 1;
    this.stage.moveTo(target.x + share * (x - target.x), target.z + share * (z - target.z));
  }

  /** The primitive of a figure's own recording at a time. */
  private presentOf({ motion }: PlacedFigure, time: number): Segment | undefined {
    const { opened, active } = this.store;
    const shown = opened.value.find((each) => each.motion.value === motion) ?? active.value;
    return shown && primitiveAt(shown.recording.value.segmentation, time);
  }

  private colorOf(segment: Segment | undefined): string {
    return (segment && this.store.colorOf(segment)) ?? NO_COLOR;
  }

  private drawTrails(): void {
    if (!this.trails) return;
    const { playhead } = this.store;
    this.trails.mesh.visible = this.store.trails.value && playhead.value > 0;
    if (!this.trails.mesh.visible) return;
    const times = Trails.times(playhead.value, TRAIL_LENGTH);
    const paths = this.placed.map((each) => this.pathsOf(each, times));
    const colors = this.placed.flatMap((each, i) => {
      const ofTimes = times.map(
        (time) => new THREE.Color(onPage(this.colorOf(this.presentOf(each, time)), theme.value)),
      );
      return paths[i]!.map(() => ofTimes);
    });
    this.trails.draw(paths.flat(), colors, this.stage.camera.position);
  }

  private pathsOf(placed: PlacedFigure, times: readonly number[]): Float32Array[] {
    const joints = handsAndFeet(placed.motion);
    const paths = joints.map(() => new Float32Array(3 * times.length));
    const pose = new Float32Array(placed.motion.head.joints.length * 3);
    times.forEach((time, i) => {
      this.placedPose(placed, time, pose);
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

/** The height of a pose's highest joint. */
function highest(pose: Float32Array): number {
  let top = -Infinity;
  for (let i = 1; i < pose.length; i += 3) if (pose[i]! > top) top = pose[i]!;
  return top;
}

/** From one to the other of the two who stand farthest apart. */
function longest(roots: readonly [number, number][]): [number, number] {
  const pairs = roots.flatMap(([x, z], i) =>
    roots.slice(i + 1).map((other): [number, number] => [other[0] - x, other[1] - z]),
  );
  return pairs.sort((a, b) => Math.hypot(...b) - Math.hypot(...a))[0] ?? [0, 0];
}

function handsAndFeet(motion: Motion): number[] {
  const { effectors } = motion.head;
  return Object.keys(effectors)
    .filter((part) => part !== "head")
    .map((part) => effectors[part]!);
}
