/** Export the segments in any format that the package writes. */
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import type { Level, LoopRow, Segment } from "../../messages";
import { saveFile, explainError } from "../server/api";
import { Dialog, type DialogProps } from "./Dialog";
import { Button, Checkbox, toggleMember, Swatch, TableHead } from "../../layout/controls";
import { NO_COLOR } from "../../colors";
import { getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { unpackLoop, type Loop } from "../../viewer/loop";
import { LoopPlayer } from "./LoopPlayer";

const CHOICES: readonly (readonly [Level | "", string])[] = [
  ["", "activities and primitives, if it holds both"],
  ["activity", "activities alone"],
  ["primitive", "primitives alone"],
];

export function ExportDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const level = useSignal<Level | "">("");
  const all = useSignal(false);
  const busy = useSignal("");
  useEffect(() => void session.refresh(), [session]);
  const recordings = session.state.value?.recordings ?? [];
  const done = recordings.filter((each) => session.list.isChecked(each)).length;
  const write = async (format: string): Promise<void> => {
    const edited = session.edited.value;
    if (!edited) return;
    busy.value = format;
    await session.notifications.attempt("export", async () => {
      const { api } = session;
      const asked = all.value
        ? api.exportAll(format, level.value)
        : api.exportSegments(edited.id, format, level.value);
      saveFile(await asked);
    });
    busy.value = "";
  };
  return (
    <Dialog title="Write the segments as a file" close={close}>
      <fieldset>
        {CHOICES.map(([each, title]) => (
          <label class="check" key={each}>
            <input
              type="radio"
              name="level"
              checked={level.value === each}
              onChange={() => (level.value = each)}
            />
            {title}
          </label>
        ))}
      </fieldset>
      <fieldset>
        <label class="check">
          <input type="radio" name="of" checked={!all.value} onChange={() => (all.value = false)} />
          this recording
        </label>
        <label class="check">
          <input
            type="radio"
            name="of"
            checked={all.value}
            disabled={!done}
            onChange={() => (all.value = true)}
          />
          every recording that is checked ({done} of {recordings.length}), as one ZIP
        </label>
      </fieldset>
      <table class="formats">
        <tbody>
          {session.state.value?.export_formats.map(({ name, suffix, help }) => (
            <tr key={name}>
              <td>
                <Button
                  data-format={name}
                  disabled={busy.value !== ""}
                  onClick={() => void write(name)}
                  busy={busy.value === name}
                >
                  {name}
                </Button>
              </td>
              <td class="quiet">{suffix}</td>
              <td>{help}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}

/** List repetitions as loops, the best of each cluster first, to play and export. */
export function LoopsDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const { edited, api, notifications, store } = session;
  const found = useSignal<LoopRow[] | null>(null);
  const problem = useSignal("");
  const chosen = useSignal<ReadonlySet<number>>(new Set());
  const busy = useSignal(false);
  const playing = useSignal<number | null>(null);
  const loop = useSignal<Loop | null>(null);
  const opened = edited.value;
  useEffect(() => {
    if (!opened) return;
    opened
      .waitUntilSent() // then its rows match those shown
      .then(() => api.loadLoops(opened.id))
      .then(({ loops }) => {
        found.value = loops;
        chosen.value = new Set(loops.filter(({ rank }) => rank === 1).map((each) => each.number));
      })
      .catch((error: unknown) => (problem.value = explainError(error)));
  }, [opened, api, found, chosen, problem]);
  const write = async (): Promise<void> => {
    busy.value = true;
    await notifications.attempt("clips", async () => {
      const rows = [...chosen.value].sort((a, b) => a - b);
      saveFile(await api.exportClips(opened!.id, { rows, loops: true }));
    });
    busy.value = false;
  };
  const play = async (number: number): Promise<void> => {
    playing.value = number;
    try {
      const found = await unpackLoop(await api.loadLoop(opened!.id, number));
      if (playing.peek() === number) loop.value = found; // another one may have been chosen
    } catch (error) {
      problem.value = explainError(error);
    }
  };
  const segments = store.table.value?.segments ?? [];
  const shown = playing.value === null ? undefined : segments[playing.value];
  return (
    <Dialog title="Repetitions as loops" close={close}>
      <p class="quiet">
        The best of each cluster come first: their ends are close to each other, and planted feet
        stay where they are. Less is better, but for speed.
      </p>
      {loop.value && shown && (
        <LoopPlayer
          loop={loop.value}
          name={getTitle(shown)}
          color={store.getColor(shown) ?? NO_COLOR}
        />
      )}
      {problem.value && <p role="alert">{problem.value}</p>}
      {!problem.value && !found.value && <span class="busy" role="status" aria-label="Measuring" />}
      {found.value?.length === 0 && <p>There are no repetitions in this recording.</p>}
      {Boolean(found.value?.length) && (
        <>
          <p>
            <Button disabled={!chosen.value.size || busy.value} onClick={() => void write()}>
              Save {chosen.value.size} as loops
            </Button>
          </p>
          <table class="formats loops number">
            <TableHead
              columns={[
                "Loop",
                "Rank",
                ["Seam", "How far the ends are from each other before blending"],
                ["Slide", "How fast planted feet move in the loop"],
                ["Turn", "In a round"],
                "Speed",
                "",
              ]}
            />
            <tbody>
              {found.value?.map((each) => {
                const segment = segments[each.number];
                if (!segment) return null;
                const name = getTitle(segment);
                return (
                  <tr key={each.number}>
                    <td>
                      <Checkbox
                        checked={chosen.value.has(each.number)}
                        onCheck={() => (chosen.value = toggleMember(chosen.value, each.number))}
                      >
                        <Swatch color={store.getColor(segment) ?? NO_COLOR} /> {name}
                      </Checkbox>
                    </td>
                    <td>{each.rank}</td>
                    <td>{(100 * each.pose_m).toFixed(1)} cm</td>
                    <td>{each.slide_m_s === null ? "–" : `${each.slide_m_s.toFixed(2)} m/s`}</td>
                    <td>{Math.round(each.turn_deg)}°</td>
                    <td>{each.speed_m_s.toFixed(2)} m/s</td>
                    <td>
                      <Button
                        aria-label={`Play ${name}`}
                        aria-pressed={playing.value === each.number}
                        title="As it will be written, round after round"
                        onClick={() => void play(each.number)}
                      >
                        Play
                      </Button>{" "}
                      <Button
                        aria-label={`Show ${name}`}
                        title="Where it is in the recording"
                        onClick={() => {
                          store.select(segment);
                          close();
                        }}
                      >
                        Show
                      </Button>
                    </td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        </>
      )}
    </Dialog>
  );
}

function getTitle(segment: Segment): string {
  return `${getSegmentName(segment)} at ${formatTime(segment.start_s, 2)}`;
}
