/** What needs attention: above the page, which gives it room, so that nothing is covered. */
import type { JSX } from "preact";
import { Offered } from "./folder/Offered";
import { useStudio } from "./context";
import type { EditedRecording } from "./editing/editedRecording";
import { Button, CloseButton } from "../layout/controls";

export function Notices(): JSX.Element {
  const { session } = useStudio();
  const { bulletin, trouble, unsent } = session;
  return (
    <div class="notices">
      <div role="alert">
        {trouble.value && (
          <div class="notice danger" data-notice="trouble">
            <p>
              {trouble.value} {unsent.value.length > 0 && <Waiting edits={unsent.value} />}
            </p>
          </div>
        )}
        {!trouble.value &&
          session.blocked.value.map((edited) => <Blocked key={edited.id} edited={edited} />)}
        {bulletin.problems.value.map(({ text }) => (
          <div class="notice danger" data-notice="problem" key={text}>
            <p>{text}</p>
            <CloseButton
              label="Dismiss"
              title="Dismiss (Escape)"
              onClick={() => bulletin.dismiss(text)}
            />
          </div>
        ))}
      </div>
      <Offered />
    </div>
  );
}

/** Edits of another table than the present one, and the choice to make or drop them. */
function Blocked({ edited }: { edited: EditedRecording }): JSX.Element {
  return (
    <div class="notice" data-notice="held">
      <p>
        {edited.confirmed.value.name}: {edited.blocked.value}. It is shown as it is now.{" "}
        <Waiting edits={edited.unsent()} />
      </p>
      <Button class="primary" onClick={() => edited.retry()}>
        Make them here
      </Button>
      <Button onClick={() => edited.drop()}>Drop them</Button>
    </div>
  );
}

function Waiting({ edits }: { edits: string[] }): JSX.Element {
  const last = edits.slice(-3);
  const more = edits.length - last.length;
  return (
    <span class="waiting">
      Not saved yet: {more > 0 && `${more} earlier, `}
      {last.join("; ")}.
    </span>
  );
}
