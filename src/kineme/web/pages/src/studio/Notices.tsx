/** Show problems and unsaved edits above the page. */
import type { JSX } from "preact";
import { NameOfferNotice } from "./folder/NameOfferNotice";
import { useStudio } from "./context";
import type { EditedRecording } from "./editing/editedRecording";
import { Button, CloseButton } from "../layout/controls";

export function Notices(): JSX.Element {
  const { session } = useStudio();
  const { notifications, trouble, unsent } = session;
  return (
    <div class="notices">
      <div role="alert">
        {trouble.value && (
          <div class="notice danger" data-notice="trouble">
            <p>
              {trouble.value} {unsent.value.length > 0 && <UnsentEdits edits={unsent.value} />}
            </p>
          </div>
        )}
        {!trouble.value &&
          session.blocked.value.map((edited) => <BlockedEdits key={edited.id} edited={edited} />)}
        {notifications.problems.value.map(({ text }) => (
          <div class="notice danger" data-notice="problem" key={text}>
            <p>{text}</p>
            <CloseButton
              label="Dismiss"
              title="Dismiss (Escape)"
              onClick={() => notifications.dismiss(text)}
            />
          </div>
        ))}
      </div>
      <NameOfferNotice />
    </div>
  );
}

/** Ask whether to apply edits that were made on an older table. */
function BlockedEdits({ edited }: { edited: EditedRecording }): JSX.Element {
  return (
    <div class="notice" data-notice="held">
      <p>
        {edited.confirmed.value.name}: {edited.blocked.value}. It is shown as it is now.{" "}
        <UnsentEdits edits={edited.describeUnsent()} />
      </p>
      <Button class="primary" onClick={() => edited.retry()}>
        Make them here
      </Button>
      <Button onClick={() => edited.discardEdits()}>Drop them</Button>
    </div>
  );
}

function UnsentEdits({ edits }: { edits: string[] }): JSX.Element {
  const last = edits.slice(-3);
  const more = edits.length - last.length;
  return (
    <span class="waiting">
      Not saved yet: {more > 0 && `${more} earlier, `}
      {last.join("; ")}.
    </span>
  );
}
