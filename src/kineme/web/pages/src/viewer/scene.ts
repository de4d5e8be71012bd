/** Brings the state of the page into the picture: which figure where, in which pose and colour. */
import * as THREE from "three";
import { NO_COLOR, onPage } from "../colors";
import type { Segment } from "../messages";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";
import { segmentAt } from "../segments";
import type { Store } from "../store";
import { cssColor, theme } from "../theme";
import { anatomyOfCached } from "./anatomy";
import { inStep, timeOf, putInPlace, sideBySide, type PlacedFigure } from "./placement";
import { Figure } from "./figure";
import { Ghost } from "./ghost";
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
    const paths = handsAndFeet(lead.motion).length * this.placed.length;
    if (!lead.segment && paths > 0) {
      this.trails = new Trails(this.stage.haze, paths, 0.022 * this.size);
      this.stage.scene.add(this.trails.mesh);
    }
    const { id } = this.store.recording.value!;
    const scene = `${this.placed.length} ${lead.segment !== null} ${id}`;
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
    const color = onPage(this.colorOf(store.present.value), theme.value);
    const shadow = cssColor("shadow");
    const [body, joint] = [cssColor("body"), cssColor("joint")];
    this.placed.forEach((each, i) => {
      const pose = this.poses[i]!;
      this.placedPose(each, timeOf(each, store.playhead.value, leader), pose);
      this.figures[i]!.pose(pose);
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
    this.placedPose(lead, timeOf(lead, this.store.playhead.value, this.leader()), this.poses[0]!);
    const { ground } = anatomyOfCached(lead.motion);
    const alone = this.placed.length === 1;
    const slots = this.placed.map((each) => each.place.slot);
    const width = Math.max(...slots.map(([x]) => x)) - Math.min(...slots.map(([x]) => x));
    const depth = Math.max(...slots.map(([, z]) => z)) - Math.min(...slots.map(([, z]) => z));
    const [x, z] = alone ? this.rootOfLead() : [0, 0];
    const side = alone ? headingAt(lead.motion, this.store.playhead.value) + 0.6 : 0.12;
    const target = new THREE.Vector3(x, ground + 0.5 * this.size, z);
    const height = (1.3 + 0.5 * (depth / this.size)) * this.size;
    this.stage.look(target, side, width + 1.25 * this.size, height, depth > 0 ? 0.5 : 0.22);
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
      const { name } = opened.recording.value;
      return opened.motion.value ? [{ motion: opened.motion.value, name }] : [];
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

  private rootOfLead(): [number, number] {
    const root = 3 * rootOf(this.placed[0]!.motion.head);
    const pose = this.poses[0]!;
    return [pose[root] || 0, pose[root + 2] || 0];
  }

  private followLead(seconds: number): void {
    if (this.placed.length !== 1) return;
    const [x, z] = this.rootOfLead();
    const { target } = this.stage.controls;
    const share = this.store.playing.value ? 1 - Math.exp(-CATCH_UP * seconds) : 1;
    this.stage.moveTo(target.x + share * (x - target.x), target.z + share * (z - target.z));
  }

  private colorOf(segment: Segment | undefined): string {
    return (segment && this.store.colorOf(segment)) ?? NO_COLOR;
  }

  private drawTrails(): void {
    if (!this.trails) return;
    const { playhead, primitives, fps } = this.store;
    this.trails.mesh.visible = this.store.trails.value && playhead.value > 0;
    if (!this.trails.mesh.visible) return;
    const times = Trails.times(playhead.value, TRAIL_LENGTH);
    const colors = times.map((time) => {
      const segment = segmentAt(primitives.value, Math.floor(time * fps.value));
      return new THREE.Color(onPage(this.colorOf(segment), theme.value));
    });
    const paths = this.placed.flatMap((each) => this.pathsOf(each, times));
    this.trails.draw(paths, colors, this.stage.camera.position);
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

function handsAndFeet(motion: Motion): number[] {
  const { effectors } = motion.head;
  return Object.keys(effectors)
    .filter((part) => part !== "head")
    .map((part) => effectors[part]!);
}
