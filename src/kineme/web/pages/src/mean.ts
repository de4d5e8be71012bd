/** Mean and sample standard deviation; null if there are too few values. */
export interface Mean {
  mean: number | null;
  deviation: number | null;
}

export function computeMean(values: readonly number[]): Mean {
  if (!values.length) return { mean: null, deviation: null };
  const mean = values.reduce((sum, each) => sum + each, 0) / values.length;
  const squares = values.reduce((sum, each) => sum + (each - mean) ** 2, 0);
  return { mean, deviation: values.length > 1 ? Math.sqrt(squares / (values.length - 1)) : null };
}
