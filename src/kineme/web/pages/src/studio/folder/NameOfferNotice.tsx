/** Offer to apply a cluster's new name to all recordings. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import { Button, CloseButton } from "../../layout/controls";

export function NameOfferNotice(): JSX.Element {
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
