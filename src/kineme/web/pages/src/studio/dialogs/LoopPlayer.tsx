/** Play a loop as it will be exported, round after round. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { adaptColor } from "../../colors";
import { theme } from "../../theme";
import { drawOnChange, ticker } from "../../ticker";
import { IconButton } from "../../transport/icons";
import { getRoundDuration, type Loop } from "../../viewer/loop";
import { LoopScene } from "../../viewer/loopScene";
import { turnByKey } from "../../viewer/updates";

interface Props {
  loop: Loop;
  name: string;
  color: string;
}

export function LoopPlayer({ loop, name, color }: Props): JSX.Element {
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
