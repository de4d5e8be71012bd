/** Return a count with its noun, such as "1 member" or "2 members". */
export function formatCount(n: number, one: string, many = `${one}s`): string {
  return `${n} ${n === 1 ? one : many}`;
}
