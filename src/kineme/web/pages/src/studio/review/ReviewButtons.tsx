/** Go to the next segment to review, optionally marking the current one. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import { Button } from "../../layout/controls";

export function ReviewButtons(): JSX.Element {
  const { review } = useStudio();
  return (
    <>
      <Button title="Next to look at (J)" onClick={() => void review.goToNext()}>
        Next
      </Button>
      <Button
        class="primary"
        title="The segment is right: mark it and go on (K)"
        onClick={() => review.checkAndGoOn()}
      >
        Checked, next
      </Button>
    </>
  );
}
