/** Show problems and unsaved edits above the page. */
import { useStudio } from "./context";
import type { EditedRecording } from "./editing/editedRecording";
import { Button, CloseButton } from "../layout/controls";

export function Notices() {
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
function BlockedEdits({ edited }: { edited: EditedRecording }) {
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

function UnsentEdits({ edits }: { edits: string[] }) {
  const last = edits.slice(-3);
  const more = edits.length - last.length;
  return (
    <span class="waiting">
      Not saved yet: {more > 0 && `${more} earlier, `}
      {last.join("; ")}.
    </span>
  );
}

/** Offer to apply a cluster's new name to all recordings. */
function NameOfferNotice() {
  const { review } = useStudio();
  const { offer } = review;
  const { value: present } = offer.present;
  if (!present) return <div role="status" />;
  const { cluster, before, label } = present;
  return (
    <div class="notice" role="status">
      <p>
        Cluster {cluster} is “{label}” here.{" "}
        {offer.isLibrary()
          ? "The library knows it in other recordings, too."
          : `In other recordings it is known by its name, “${before}”.`}
      </p>
      <Button class="primary" onClick={() => void offer.accept()}>
        “{label}” in all recordings
      </Button>
      <CloseButton label="Here only" onClick={() => (offer.present.value = null)} />
    </div>
  );
}
