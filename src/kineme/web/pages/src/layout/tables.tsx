/** Tables, also long ones that render only the visible rows and can be ordered. */
import { useSignal, type Signal } from "@preact/signals";
import type { ComponentChildren, HTMLAttributes } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { Button } from "./controls";

const OVERSCAN = 6; // rows rendered above and below the visible ones

/** A column's title, or title and tooltip. */
type Column = string | readonly [title: string, tooltip: string];

export interface Row extends HTMLAttributes<HTMLTableRowElement> {
  key: string | number;
  /** Heading of the row, in its first cell. */
  head?: ComponentChildren;
  cells: readonly ComponentChildren[];
}

interface TableProps {
  class: string;
  caption?: ComponentChildren;
  columns?: readonly Column[];
  rows: readonly Row[];
}

/** Render a table with its head, if there are titles of columns. */
export function Table({ class: name, caption, columns, rows }: TableProps) {
  return (
    <table class={name}>
      {caption && <caption>{caption}</caption>}
      {columns && (
        <thead>
          <tr>
            {columns.map((column) => {
              const [title, tooltip] = typeof column === "string" ? [column] : column;
              return (
                <th key={title} scope={title ? "col" : undefined} title={tooltip}>
                  {title}
                </th>
              );
            })}
          </tr>
        </thead>
      )}
      <tbody>
        {rows.map(({ key, head, cells, ...rest }) => (
          <tr key={key} {...rest}>
            {head !== undefined && <th scope="row">{head}</th>}
            {cells.map((cell, i) => (
              <td key={i}>{cell}</td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

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
export type ColumnOrder<Id> = [Id, boolean];

/** Render a column's title; a click orders the rows by it, another one reverses them. */
export function OrderButton<Id>(props: {
  order: Signal<ColumnOrder<Id>>;
  column: Id;
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
