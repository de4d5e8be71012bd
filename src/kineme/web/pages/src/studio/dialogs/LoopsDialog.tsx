/** List repetitions as loops, and play a loop as it will be exported, round after round. */
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as THREE from "three";
import { adaptColor, NO_COLOR } from "../../colors";
import { drawOnChange, readColor, theme, ticker } from "../../drawing";
import {
  Button,
  Checkbox,
  Dialog,
  IconButton,
  Swatch,
  toggleMember,
  useBusy,
} from "../../layout/controls";
import { Table } from "../../layout/tables";
import type { LoopRow, Segment } from "../../messages";
import { findRoot, getHeading } from "../../motion";
import { getSegmentName } from "../../segments";
import { formatTime } from "../../view";
import { Figure } from "../../viewer/figure";
import {
  computeLoopPose,
  getAnatomy,
  getRoundDuration,
  type Loop,
  unpackLoop,
} from "../../viewer/placement";
import { Stage } from "../../viewer/stage";
import { turnByKey } from "../../viewer/Viewer";
import { type DialogProps, useStudio } from "../context";
import { explainError, saveFile } from "../server/api";

const COLUMNS = [
  "Loop",
  "Rank",
  ["Seam", "How far the ends are from each other before blending"],
  ["Slide", "How fast planted feet move in the loop"],
  ["Turn", "In a round"],
  "Speed",
  "",
] as const;

/** List repetitions as loops, the best of each cluster first, to play and export. */
export function LoopsDialog({ close }: DialogProps) {
  const { session } = useStudio();
  const { edited, api, notifications, store } = session;
  const found = useSignal<LoopRow[] | null>(null);
  const problem = useSignal("");
  const chosen = useSignal<ReadonlySet<number>>(new Set());
  const [busy, run] = useBusy();
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
  const write = (): Promise<boolean> =>
    notifications.attempt("clips", async () => {
      const rows = [...chosen.value].sort((a, b) => a - b);
      saveFile(await api.exportClips(opened!.id, { rows, loops: true }));
    });
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
            <Button
              disabled={!chosen.value.size || busy !== ""}
              onClick={() => void run("clips", write)}
            >
              Save {chosen.value.size} as loops
            </Button>
          </p>
          <Table
            class="formats loops number"
            columns={COLUMNS}
            rows={(found.value ?? []).flatMap((each) => {
              const segment = segments[each.number];
              if (!segment) return [];
              const name = getTitle(segment);
              const cells = [
                <Checkbox
                  checked={chosen.value.has(each.number)}
                  onCheck={() => (chosen.value = toggleMember(chosen.value, each.number))}
                >
                  <Swatch color={store.getColor(segment)} /> {name}
                </Checkbox>,
                each.rank,
                `${(100 * each.pose_m).toFixed(1)} cm`,
                each.slide_m_s === null ? "–" : `${each.slide_m_s.toFixed(2)} m/s`,
                `${Math.round(each.turn_deg)}°`,
                `${each.speed_m_s.toFixed(2)} m/s`,
                <>
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
                </>,
              ];
              return [{ key: each.number, cells }];
            })}
          />
        </>
      )}
    </Dialog>
  );
}

function getTitle(segment: Segment): string {
  return `${getSegmentName(segment)} at ${formatTime(segment.start_s, 2)}`;
}

/** Play a loop round after round. */
function LoopPlayer({ loop, name, color }: { loop: Loop; name: string; color: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<LoopScene | null>(null);
  const playing = useSignal(true);
  const turned = useSignal(0); // turns of the camera, and other sizes
  const playhead = useSignal(0);

  useEffect(() => {
    const element = canvas.current!;
    const made = (scene.current = new LoopScene(element));
    const { stage } = made;
    const redraw = (): void => void (turned.value += 1);
    stage.controls.addEventListener("change", redraw);
    const resize = new ResizeObserver(() => {
      stage.resize(element.clientWidth, element.clientHeight);
      redraw();
    });
    resize.observe(element);
    return () => {
      resize.disconnect();
      made.dispose();
    };
  }, [turned]);

  useEffect(() => {
    const shown = scene.current!;
    shown.show(loop);
    playhead.value = 0;
    playing.value = true;
    const advance = ticker.add((seconds) => {
      if (playing.peek()) playhead.value += seconds;
    });
    const stop = drawOnChange(
      () => void [turned.value, playing.value, playhead.value, theme.value],
      (since) => {
        shown.draw(playhead.peek(), adaptColor(color, theme.peek()));
        shown.stage.draw(playing.peek(), since);
      },
    );
    return () => {
      advance();
      stop();
    };
  }, [loop, color, playing, turned, playhead]);

  return (
    <div class="loop-player" data-playing={playing.value}>
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label={`${name}, round after round. Drag or press alt and an arrow key to look from another side.`}
        onKeyDown={(event) => turnByKey(event, scene.current)}
      />
      <RoundBar playhead={playhead} lasts={getRoundDuration(loop)} />
      <p>
        <IconButton
          icon={playing.value ? "pause" : "play"}
          label={playing.value ? "Pause" : "Play"}
          onClick={() => (playing.value = !playing.value)}
        />
        {name}
        <span class="quiet number">{getRoundDuration(loop).toFixed(2)} s a round</span>
      </p>
    </div>
  );
}

/** Show how much of the round has been played. */
function RoundBar({ playhead, lasts }: { playhead: Signal<number>; lasts: number }) {
  return <span class="round-done" style={{ width: `${100 * ((playhead.value / lasts) % 1)}%` }} />;
}

/** Draw a loop on its own stage; the camera follows the figure. */
class LoopScene {
  readonly stage: Stage;
  private loop: Loop | null = null;
  private figure: Figure | null = null;
  private pose = new Float32Array();

  constructor(canvas: HTMLCanvasElement) {
    this.stage = new Stage(canvas);
  }

  /** Show another loop, seen from its side. */
  show(loop: Loop): void {
    this.clear();
    const { head } = loop.motion;
    const anatomy = getAnatomy(loop.motion);
    this.loop = loop;
    this.figure = new Figure(this.stage.fog, head, anatomy);
    this.pose = new Float32Array(3 * head.joints.length);
    this.stage.scene.add(this.figure.group);
    this.stage.fit(anatomy.size, anatomy.ground);
    computeLoopPose(loop, 0, this.pose);
    const [x, z] = this.getRootPosition();
    const target = new THREE.Vector3(x, anatomy.ground + 0.5 * anatomy.size, z);
    const side = getHeading(loop.motion, 0) + 0.9;
    this.stage.lookAt(target, side, 1.25 * anatomy.size, 1.3 * anatomy.size);
  }

  /** Pose and colour the figure for a time in seconds. */
  draw(seconds: number, color: string): void {
    this.stage.setColors();
    this.figure!.setColors({ body: readColor("body"), joint: color, shadow: readColor("shadow") });
    computeLoopPose(this.loop!, seconds, this.pose);
    this.figure!.setPose(this.pose);
    this.stage.moveTo(...this.getRootPosition());
  }

  dispose(): void {
    this.clear();
    this.stage.dispose();
  }

  private getRootPosition(): [number, number] {
    const root = 3 * findRoot(this.loop!.motion.head);
    return [this.pose[root] || 0, this.pose[root + 2] || 0];
  }

  private clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
  }
}
