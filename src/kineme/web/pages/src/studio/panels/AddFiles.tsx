/** Choose files to upload and show their progress. */
import type { JSX } from "preact";
import { useStudio } from "../context";

export function AddFiles(): JSX.Element {
  const { uploads } = useStudio();
  return (
    <>
      <label
        class="button"
        title="Add files to the folder; dropping them on the page does the same"
      >
        Add…
        <input
          class="unseen"
          type="file"
          multiple
          onChange={(event) => {
            const input = event.currentTarget;
            void uploads.add([...(input.files ?? [])]);
            input.value = "";
          }}
        />
      </label>
      {uploads.running.value.map(({ name, share }) => (
        <span class="upload" key={name}>
          <span>{name}</span>
          <progress value={share} aria-label={`Sending ${name}`} />
        </span>
      ))}
    </>
  );
}
