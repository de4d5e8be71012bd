/** Play a loop as it will be exported, round after round. */
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { adaptColor } from "../../colors";
import { theme, readColor } from "../../theme";
import { drawOnChange, ticker } from "../../ticker";
import { IconButton } from "../../layout/controls";
import { getRoundDuration, type Loop, computeLoopPose } from "../../viewer/loop";
import { turnByKey } from "../../viewer/updates";
import * as THREE from "three";
import { getHeading, findRoot } from "../../motion";
import { getAnatomy } from "../../viewer/anatomy";
import { Figure } from "../../viewer/figure";
import { Stage } from "../../viewer/stage";

interface Props {
  loop: Loop;
  name: string;
  color: string;
}

export function LoopPlayer({ loop, name, color }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const place = useRef<HTMLSpanElement>(null);
  const scene = useRef<LoopScene | null>(null);
  const playing = useSignal(true);
  const turned = useSignal(0);
  const playhead = useRef(0);

  useEffect(() => {
    const element = canvas.current!;
    const made = new LoopScene(element, () => (turned.value += 1));
    scene.current = made;
    const resize = new ResizeObserver(() => {
      made.resize(element.clientWidth, element.clientHeight);
      turned.value += 1;
    });
    resize.observe(element);
    return () => {
      resize.disconnect();
      made.dispose();
    };
  }, [turned]);

  useEffect(() => {
    const [stage, bar] = [scene.current!, place.current!];
    stage.show(loop);
    playhead.current = 0;
    playing.value = true;
    const lasts = getRoundDuration(loop);
    const advance = ticker.add((seconds) => {
      if (!playing.peek()) return;
      playhead.current += seconds;
      turned.value += 1;
    });
    const stop = drawOnChange(
      () => void [turned.value, playing.value, theme.value],
      (since) => {
        const moving = playing.peek();
        stage.draw(playhead.current, adaptColor(color, theme.peek()), { moving, since });
        bar.style.width = `${100 * ((playhead.current / lasts) % 1)}%`;
      },
    );
    return () => {
      advance();
      stop();
    };
  }, [loop, color, playing, turned]);

  return (
    <div class="loop-player" data-playing={playing.value}>
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label={`${name}, round after round. Drag or press alt and an arrow key to look from another side.`}
        onKeyDown={(event) => turnByKey(event, scene.current)}
      />
      <span class="round-done" ref={place} />
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

/** Draw a loop on its own stage; the camera follows the figure. */
class LoopScene {
  readonly stage: Stage;
  private loop: Loop | null = null;
  private figure: Figure | null = null;
  private pose = new Float32Array();

  constructor(canvas: HTMLCanvasElement, redraw: () => void) {
    this.stage = new Stage(canvas);
    this.stage.controls.addEventListener("change", redraw);
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

  /** Draw the loop at a time in seconds. */
  draw(
    seconds: number,
    color: string,
    { moving, since }: { moving: boolean; since: number },
  ): void {
    if (!this.loop || !this.figure) return;
    this.stage.setColors();
    this.figure.setColors({
      body: readColor("body"),
      joint: color,
      shadow: readColor("shadow"),
    });
    computeLoopPose(this.loop, seconds, this.pose);
    this.figure.setPose(this.pose);
    this.stage.moveTo(...this.getRootPosition());
    this.stage.draw(moving, since);
  }

  resize(width: number, height: number): void {
    this.stage.resize(width, height);
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
