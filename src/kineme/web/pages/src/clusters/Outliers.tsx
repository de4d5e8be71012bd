/** List the current repetition, those farthest from the mean and the excluded ones. */
import type { JSX } from "preact";
import { useStore } from "../context";
import type { ClusterCurves, CycleCurve } from "../messages";
import { formatNumber, computeRange, selectCycle, appendUnit } from "./cycles";
import { Button } from "../layout/controls";

const MAX_FARTHEST = 3;

interface OutlierProps {
  curves: ClusterCurves;
  /** Indices of the excluded repetitions. */
  leftOut: ReadonlySet<number>;
}

/** Show the repetition at the playhead and its distance from the mean. */
export function CurrentCycle({ curves, leftOut, at }: OutlierProps & { at: number }): JSX.Element {
  const store = useStore();
  const cycle = curves.cycles[at];
  if (!cycle) return <p class="chosen quiet">None of them at the playhead.</p>;
  const isOut = leftOut.has(at);
  const range = computeRange(cycle);
  const key = store.selected.value?.start_frame === cycle.start_frame ? " (X)" : "";
  const edit = store.edit.value;
  return (
    <p class="chosen" aria-label="At the playhead">
      <span class="number">{cycle.start_s.toFixed(2)} s</span>
      {range !== null && (
        <span class="quiet">range {appendUnit(formatNumber(range), curves.unit)}</span>
      )}
      <span class="quiet">
        {isOut ? "left out by hand" : describeDeviation(cycle, curves.unit)}
      </span>
      <span class="spacer" />
      {edit && (
        <Button
          title={(isOut ? "Count it in the mean again" : "Leave it out of the mean") + key}
          onClick={() => edit({ kind: "exclude", frames: [cycle.start_frame], excluded: !isOut })}
        >
          {isOut ? "Bring back" : "Leave out"}
        </Button>
      )}
    </p>
  );
}

/** List the repetitions farthest from the mean, with buttons to exclude them. */
export function FarthestCycles({ curves, leftOut }: OutlierProps): JSX.Element | null {
  const { cycles, unit, n } = curves;
  if (n < 3) return null;
  const inMean = cycles.filter(({ counts }, i) => counts && !leftOut.has(i));
  return (
    <p class="farthest" aria-label="Farthest from the mean">
      <span class="quiet">Farthest:</span>
      {inMean.slice(0, MAX_FARTHEST).map((cycle) => (
        <CycleChip
          key={cycle.start_frame}
          cycle={cycle}
          deviation={describeDeviation(cycle, unit)}
          excluded={true}
        />
      ))}
    </p>
  );
}

/** List the excluded repetitions, with buttons to include them again. */
export function ExcludedCycles({ curves, leftOut }: OutlierProps): JSX.Element | null {
  if (!leftOut.size) return null;
  return (
    <p class="farthest left-out" aria-label="Left out by hand">
      <span class="quiet">Left out:</span>
      {curves.cycles.map(
        (cycle, i) =>
          leftOut.has(i) && (
            <CycleChip
              key={cycle.start_frame}
              cycle={cycle}
              deviation="left out by hand"
              excluded={false}
            />
          ),
      )}
    </p>
  );
}

interface ChipProps {
  cycle: CycleCurve;
  deviation: string;
  /** The state that a click on the second button sets. */
  excluded: boolean;
}

function CycleChip({ cycle, deviation, excluded }: ChipProps): JSX.Element {
  const store = useStore();
  const edit = store.edit.value;
  const at = `${cycle.start_s.toFixed(1)} s`;
  const what = excluded ? "Leave out of the mean" : "Bring back into the mean";
  return (
    <span class="chip">
      <Button
        title={`${deviation}, from ${cycle.start_s.toFixed(2)} to ${cycle.stop_s.toFixed(2)} s`}
        onClick={() => selectCycle(store, cycle)}
      >
        {at}
      </Button>
      {edit && (
        <Button
          title={what}
          aria-label={`${what}: ${at}`}
          onClick={({ detail }) => {
            // Ignore double clicks: the next chip moves under the pointer.
            if (detail < 2) edit({ kind: "exclude", frames: [cycle.start_frame], excluded });
          }}
        >
          {excluded ? "×" : "↺"}
        </Button>
      )}
    </span>
  );
}

/** Describe a repetition's distance from the mean and why it is not included. */
function describeDeviation({ distance, note }: CycleCurve, unit: string): string {
  const number = distance?.toPrecision(2);
  const far = number === undefined ? "" : appendUnit(number, unit);
  return [far && `${far} from the mean`, note].filter(Boolean).join(", ");
}
