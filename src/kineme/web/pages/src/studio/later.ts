/** Ends after so many milliseconds, such as between two looks at how far the server is. */
export function later(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}
