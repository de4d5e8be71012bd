/** Show a table of keys and their actions. */
import type { JSX } from "preact";

export function Keys({ keys }: { keys: readonly (readonly [string, string])[] }): JSX.Element {
  return (
    <table class="keys">
      <tbody>
        {keys.map(([key, what]) => (
          <tr key={key}>
            <th scope="row">
              <kbd>{key}</kbd>
            </th>
            <td>{what}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
