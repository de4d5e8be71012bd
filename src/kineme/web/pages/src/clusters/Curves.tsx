/** All members of a cluster laid over each other, from their beginning to their end. */
import { computed, useSignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import type { CurveTiles } from "../channels/tiles";
import { useTiles } from "../channels/useTiles";
import { clusterColor } from "../colors";
import type { Segment } from "../messages";
import type { Motion } from "../motion";
import type { Store } from "../store";
import { AXES, coursesOfChannels, coursesOfMotion, type Course } from "./courses";
import { curveOf, distanceFrom, farthest, liveliest, pointsFor, someOf, spreadOf } from "./curves";
import { drawCurves, LEFT, nearestCurve, RIGHT } from "./curveDrawing";
import { phasesOf } from "./phases";

const MOST = 150; // curves drawn, and members that the mean is of
const FEW = 12; // members looked at to choose a course
const FIRST = 6; // channels, or joints of a body that nothing is known of, looked at for that
const FARTHEST = 3; // members named that differ most from the mean

export function Curves(): JSX.Element {
  const store = useStore();
  const tiles = useTiles();
  const chosen = useSignal<string | null>(null);
  const shown = useMemo(
    () => computed(() => contentOf(store, tiles.value, chosen.value)),
    [store, tiles, chosen],
  );
  const member = useMemo(
    () => computed(() => (shown.value ? memberAt(store, shown.value) : -1)),
    [store, shown],
  );
  const content = shown.value;
  if (!content) return <Missing />;
  const { courses, course, members, phases, color } = content;
  const all = store.shownCluster.value?.members.length ?? 0;
  const turned = phases.filter((phase) => phase > 0).length;
  const plural = members.length === 1 && all <= 1 ? "member" : "members";
  const memberCount = `${members.length < all ? `${members.length} of ${all}` : members.length} ${plural}`;
  const groups = [...new Set(courses.map(({ group }) => group))];
  const choose = (found: Course | undefined): void => {
    if (found) chosen.value = nameOf(found);
  };
  return (
    <div class="curves">
      <div class="curve-choice">
        <span class="swatch" style={{ background: color }} />
        <select
          aria-label="Joint or channel"
          value={course.name}
          onChange={({ currentTarget: { value } }) =>
            choose(courses.find(({ group, name }) => name === value && group === course.group))
          }
        >
          {courses
            .filter(({ group }) => group === course.group)
            .map(({ name }) => (
              <option key={name} value={name}>
                {name}
              </option>
            ))}
        </select>
        <select
          aria-label="What of it"
          value={course.group}
          onChange={({ currentTarget: { value } }) => {
            const those = courses.filter(({ group }) => group === value);
            choose(those.find(({ name }) => name === course.name) ?? those[0]);
          }}
        >
          {groups.map((group) => (
            <option key={group} value={group}>
              {group}
            </option>
          ))}
        </select>
        <span class="quiet">{course.unit}</span>
      </div>
      <div class="curve-room">
        <Canvas
          label={`Curves of ${memberCount}, with mean and deviation. Click one to go to its member.`}
          watch={() => void [shown.value, member.value]}
          draw={(pen, width, height) => {
            const now = shown.value;
            if (now) drawCurves(pen, { ...now, selected: member.value }, width, height);
          }}
          onClick={(event) => {
            const { left, top, width, height } = event.currentTarget.getBoundingClientRect();
            const [x, y] = [event.clientX - left, event.clientY - top];
            const nearest = members[nearestCurve(content.curves, x, y, width, height)];
            if (nearest) store.select(nearest);
          }}
        />
        <Now members={members} phases={phases} />
      </div>
      <Farthest content={content} />
      <p class="quiet note">
        {memberCount}, mean ± deviation
        {AXES.some((axis) => axis === course.group) && ", seen from the pelvis"}
        {turned > 0 &&
          `; ${turned} cut at another phase of the cycle, turned to that of the others`}
      </p>
    </div>
  );
}

type Content = NonNullable<ReturnType<typeof contentOf>>;

function contentOf(store: Store, tiles: CurveTiles | null, chosen: string | null) {
  const active = store.active.value;
  const motion = active?.motion.value;
  const cluster = store.shownCluster.value ?? store.clusters.value[0];
  if (!active || !cluster) return null;
  void tiles?.settled.value;
  const fps = store.fps.value;
  const channels = tiles ? coursesOfChannels(tiles, fps) : [];
  const courses = [...(motion ? coursesOfMotion(motion) : []), ...channels];
  const members = someOf(cluster.members, MOST);
  const telling = motion ? ofEnds(motion, courses) : channels.slice(0, FIRST);
  if (!telling.length) return null;
  const phases = phasesOf(telling, members);
  const some = someOf([...members.keys()], FEW);
  const of = <T,>(all: readonly T[]): T[] => some.map((i) => all[i]!);
  const size = (course: Course): number => extentOf(tiles, channels.indexOf(course));
  const course =
    courses.find((each) => nameOf(each) === chosen) ??
    liveliest(telling, of(members), of(phases), motion ? undefined : size)!;
  const points = pointsFor(course.fps, members);
  const curves = members.map((each, i) => curveOf(course, each, points, phases[i]));
  const color = clusterColor(cluster.id);
  return { courses, course, members, phases, curves, spread: spreadOf(curves), color };
}

/** Where hands, feet and head are; of a body that nothing is known of, some of its joints. */
function ofEnds({ head: { effectors, joints } }: Motion, courses: readonly Course[]): Course[] {
  const parts = Object.keys(effectors).filter((part) => part !== "pelvis");
  const ends = parts.length
    ? parts.map((part) => joints[effectors[part]!]!)
    : someOf(joints, FIRST);
  return courses.filter(
    ({ group, name }) => AXES.some((axis) => axis === group) && ends.includes(name),
  );
}

/** From the least to the greatest value of a channel. */
function extentOf(tiles: CurveTiles | null, channel: number): number {
  const [low, high] = tiles?.bounds(channel) ?? [0, 1];
  return high - low || 1;
}

function nameOf({ group, name }: Course): string {
  return `${group}: ${name}`;
}

/** The members that differ most from the mean, each a way to it. */
function Farthest({ content }: { content: Content }): JSX.Element | null {
  const store = useStore();
  const { members, curves, spread, course } = content;
  if (members.length < 3) return null;
  return (
    <p class="farthest" aria-label="Farthest from the mean">
      <span class="quiet">Farthest:</span>
      {farthest(spread, curves, FARTHEST).map((i) => {
        const each = members[i]!;
        const far = `${distanceFrom(spread, curves[i]!).toPrecision(2)} ${course.unit}`.trim();
        return (
          <button
            key={i}
            type="button"
            title={`${far} from the mean, from ${each.start_s.toFixed(2)} to ${each.stop_s.toFixed(2)} s`}
            onClick={() => store.select(each)}
          >
            {each.start_s.toFixed(1)} s
          </button>
        );
      })}
    </p>
  );
}

/** The member under the playhead, else the selected one. */
function memberAt(store: Store, { members }: Content): number {
  const at = store.frame.value;
  const present = members.findIndex((each) => each.start_frame <= at && at < each.stop_frame);
  if (present >= 0) return present;
  const selected = store.selected.value;
  return members.findIndex((each) => each.start_frame === selected?.start_frame);
}

/** How far the present repetition is; apart from the canvas, so that playing redraws no curves. */
function Now(props: { members: readonly Segment[]; phases: readonly number[] }): JSX.Element {
  const store = useStore();
  const { members, phases } = props;
  const at = store.playhead.value;
  const number = members.findIndex((each) => each.start_s <= at && at < each.stop_s);
  const present = members[number];
  const done = present ? (at - present.start_s) / (present.stop_s - present.start_s) : -1;
  const share = present ? (done - phases[number]! + 1) % 1 : -1;
  return (
    <div class="curve-now" style={{ left: `${LEFT}px`, right: `${RIGHT}px` }}>
      {share >= 0 && <Line share={share} />}
    </div>
  );
}

function Missing(): JSX.Element {
  return <p class="empty quiet">No cluster to show.</p>;
}
