/** On to the next place to look at, with or without a mark on this one. */
import type { JSX } from "preact";
import { useStudio } from "../context";
import { Button } from "../../layout/controls";

export function ReviewButtons(): JSX.Element {
  const { review } = useStudio();
  return (
    <>
      <Button title="Next to look at (J)" onClick={() => void review.next()}>
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
