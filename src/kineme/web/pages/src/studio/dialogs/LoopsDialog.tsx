/** The repetitions as loops, the best of each cluster first: played, and written as files. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useStudio } from "../context";
import type { LoopRow, Segment } from "../../messages";
import { NO_COLOR } from "../../colors";
import { nameOf } from "../../segments";
import { clock } from "../../view";
import { unpackLoop, type Loop } from "../../viewer/loop";
import { explain } from "../server/api";
import { save } from "../server/save";
import { Dialog } from "./Dialog";
import { LoopPlayer } from "./LoopPlayer";
import { Button, Checkbox, toggled } from "../../layout/controls";

interface Props {
  close: () => void;
}

export function LoopsDialog({ close }: Props): JSX.Element {
  const { session } = useStudio();
  const { edited, api, bulletin, store } = session;
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
      .settled() // its rows are those that are shown then
      .then(() => api.loops(opened.id))
      .then((loops) => {
        found.value = loops;
        chosen.value = new Set(loops.filter(({ rank }) => rank === 1).map((each) => each.number));
      })
      .catch((error: unknown) => (problem.value = explain(error)));
  }, [opened, api, found, chosen, problem]);
  const write = async (): Promise<void> => {
    busy.value = true;
    await bulletin.attempt("clips", async () => {
      const rows = [...chosen.value].sort((a, b) => a - b);
      save(await api.clips(opened!.id, { rows, loops: true }));
    });
    busy.value = false;
  };
  const play = async (number: number): Promise<void> => {
    playing.value = number;
    try {
      const found = await unpackLoop(await api.loop(opened!.id, number));
      if (playing.peek() === number) loop.value = found; // not another one since
    } catch (error) {
      problem.value = explain(error);
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
          name={titleOf(shown)}
          color={store.colorOf(shown) ?? NO_COLOR}
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
            <thead>
              <tr>
                <th scope="col">Loop</th>
                <th scope="col">Rank</th>
                <th scope="col" title="How far the ends are from each other before blending">
                  Seam
                </th>
                <th scope="col" title="How fast planted feet move in the loop">
                  Slide
                </th>
                <th scope="col" title="In a round">
                  Turn
                </th>
                <th scope="col">Speed</th>
                <th />
              </tr>
            </thead>
            <tbody>
              {found.value?.map((each) => {
                const segment = segments[each.number];
                if (!segment) return null;
                const name = titleOf(segment);
                return (
                  <tr key={each.number}>
                    <td>
                      <Checkbox
                        checked={chosen.value.has(each.number)}
                        onCheck={() => (chosen.value = toggled(chosen.value, each.number))}
                      >
                        <span
                          class="swatch"
                          style={{ background: store.colorOf(segment) ?? NO_COLOR }}
                        />{" "}
                        {name}
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

function titleOf(segment: Segment): string {
  return `${nameOf(segment)} at ${clock(segment.start_s, 2)}`;
}
