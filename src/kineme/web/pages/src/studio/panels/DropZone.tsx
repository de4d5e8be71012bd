/** Upload files dropped anywhere on the page. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { listen } from "../../layout/browser";
import { useStudio } from "../context";

export function DropZone(): JSX.Element | null {
  const { session, uploads } = useStudio();
  const over = useSignal(false);
  useEffect(() => {
    const holdsFiles = (event: DragEvent): boolean =>
      event.dataTransfer?.types.includes("Files") ?? false;
    const onOver = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      over.value = true;
    };
    const onLeave = (event: DragEvent): void => {
      if (event.relatedTarget === null) over.value = false;
    };
    const onDrop = (event: DragEvent): void => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      over.value = false;
      void uploads.add([...(event.dataTransfer?.files ?? [])]);
    };
    return listen(window, { dragover: onOver, dragleave: onLeave, drop: onDrop });
  }, [uploads, over]);
  if (!over.value) return null;
  return (
    <div class="drop-zone" aria-hidden="true">
      <p>Drop to add to {session.state.value?.folder}</p>
    </div>
  );
}
