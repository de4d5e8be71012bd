/** All members of a cluster laid over each other, from their beginning to their end. */
import { computed, useSignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { JSX } from "preact";
import { useStore } from "../context";
import { Canvas } from "../canvas/Canvas";
import { Line } from "../canvas/Line";
import { clusterColor } from "../colors";
import type { Segment } from "../messages";
import type { Store } from "../store";
import {
  AXES,
  curveOf,
  liveliest,
  pointsFor,
  someOf,
  spreadOf,
  type Axis,
  type Track,
} from "./curves";
import { phasesOf } from "./phases";
import { drawCurves, LEFT, nearestCurve, RIGHT } from "./curveDrawing";

const MOST = 150; // curves drawn, and members that the mean is of
const FEW = 12; // members looked at to choose a joint

export function Curves(): JSX.Element {
  const store = useStore();
  const chosen = useSignal<Partial<Track>>({});
  const shown = useMemo(() => computed(() => contentOf(store, chosen.value)), [store, chosen]);
  const member = useMemo(
    () => computed(() => (shown.value ? memberAt(store, shown.value) : -1)),
    [store, shown],
  );
  const content = shown.value;
  if (!content) return <Missing />;
  const { motion, track, members, phases, color } = content;
  const all = store.shownCluster.value?.members.length ?? 0;
  const turned = phases.filter((phase) => phase > 0).length;
  const plural = members.length === 1 && all <= 1 ? "member" : "members";
  const memberCount = `${members.length < all ? `${members.length} of ${all}` : members.length} ${plural}`;
  return (
    <div class="curves">
      <div class="curve-choice">
        <span class="swatch" style={{ background: color }} />
        <select
          aria-label="Joint"
          value={track.joint}
          onChange={(event) =>
            (chosen.value = { ...track, joint: Number(event.currentTarget.value) })
          }
        >
          {motion.head.joints.map((name, joint) => (
            <option key={joint} value={joint}>
              {name}
            </option>
          ))}
        </select>
        <select
          aria-label="Axis"
          value={track.axis}
          onChange={(event) =>
            (chosen.value = { ...track, axis: event.currentTarget.value as Axis })
          }
        >
          {AXES.map((axis) => (
            <option key={axis} value={axis}>
              {axis}
            </option>
          ))}
        </select>
        <span class="quiet">metres</span>
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
      <p class="quiet note">
        {memberCount}, mean ± deviation, seen from the pelvis
        {turned > 0 &&
          `; ${turned} cut at another phase of the cycle, turned to that of the others`}
      </p>
    </div>
  );
}

type Content = NonNullable<ReturnType<typeof contentOf>>;

function contentOf(store: Store, chosen: Partial<Track>) {
  const motion = store.active.value?.motion.value;
  const cluster = store.shownCluster.value ?? store.clusters.value[0];
  if (!motion || !cluster) return null;
  const members = someOf(cluster.members, MOST);
  const phases = phasesOf(motion, members);
  const some = someOf([...members.keys()], FEW);
  const of = <T,>(all: readonly T[]): T[] => some.map((i) => all[i]!);
  const track = { ...liveliest(motion, of(members), of(phases)), ...chosen };
  const points = pointsFor(motion, members);
  const curves = members.map((member, i) => curveOf(motion, member, track, points, phases[i]));
  const color = clusterColor(cluster.id);
  return { motion, track, members, phases, curves, spread: spreadOf(curves), color };
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
  const store = useStore();
  const bodiless = store.recording.value?.motion === null;
  return (
    <p class="empty quiet">
      {bodiless ? "Curves need a skeleton; this recording has none." : "No cluster to show."}
    </p>
  );
}
