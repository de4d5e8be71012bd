/** Parts of tables that render only the visible rows and can be ordered. */
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Button } from "../layout/controls";

const OVERSCAN = 6; // rows rendered above and below the visible ones

/** Return the range of rows to render, and the reference and listener of their scrolling element. */
export function useVisibleRows(rowHeight: number) {
  const ref = useRef<HTMLDivElement>(null);
  const top = useSignal(0);
  const height = useSignal(600);
  useEffect(() => {
    const place = ref.current!;
    const sized = new ResizeObserver(() => (height.value = place.clientHeight));
    sized.observe(place);
    return () => sized.disconnect();
  }, [height]);
  return {
    ref,
    onScroll: () => void (top.value = ref.current!.scrollTop),
    from: Math.max(Math.floor(top.value / rowHeight) - OVERSCAN, 0),
    to: Math.ceil((top.value + height.value) / rowHeight) + OVERSCAN,
  };
}

/** A column, and whether its order is reversed. */
export type ColumnOrder<Column> = [Column, boolean];

/** Render a column's title; a click orders the rows by it, another one reverses them. */
export function OrderButton<Column>(props: {
  order: Signal<ColumnOrder<Column>>;
  column: Column;
  title: string;
  tooltip: string;
}) {
  const { order, column, title, tooltip } = props;
  const [by, reverse] = order.value;
  return (
    <Button
      class="plain"
      title={tooltip}
      onClick={() => (order.value = [column, by === column && !reverse])}
    >
      {title}
      {by === column && (reverse ? " ▾" : " ▴")}
    </Button>
  );
}
