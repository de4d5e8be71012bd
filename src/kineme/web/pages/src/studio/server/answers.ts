/** Represent and explain the outcomes of a request. */
import type { Failure } from "../../messages";

/** A file to save. */
export interface Download {
  name: string;
  data: Blob;
}

export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
    readonly body: unknown,
  ) {
    super(message);
  }
}

export class Unreachable extends Error {
  constructor() {
    super("The studio's server does not answer.");
  }
}

/** Return the people to choose from if a recording could not be read, else null. */
export function getUnreadPeople(error: unknown): string[] | null {
  const failure = error instanceof Refused ? (error.body as Partial<Failure> | null) : null;
  return failure?.reading ? (failure.people ?? []) : null;
}

/** Return whether a video's poses must be estimated first. */
export function needsPoses(error: unknown): boolean {
  return error instanceof Refused && Boolean((error.body as Partial<Failure> | null)?.poses);
}

/** Return a message for anything that was thrown. */
export function explainError(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Return the file name of a Content-Disposition header, the UTF-8 form first; empty if none. */
export function parseFilename(disposition: string): string {
  const encoded = /filename\*=utf-8''([^;]+)/i.exec(disposition)?.[1];
  if (encoded) return decodeURIComponent(encoded);
  return /filename="?([^";]+)"?/i.exec(disposition)?.[1] ?? "";
}

/** Return the answer, or null for status 404. */
export async function nullIfMissing<T>(answer: Promise<T>): Promise<T | null> {
  try {
    return await answer;
  } catch (error) {
    if (error instanceof Refused && error.status === 404) return null;
    throw error;
  }
}

export async function catchNetworkError<T>(work: Promise<T>): Promise<T> {
  try {
    return await work;
  } catch {
    throw new Unreachable();
  }
}

export function parseJson(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

export function getErrorMessage(body: unknown, status: number): string {
  const error = (body as Partial<Failure> | null)?.error;
  return error ?? `The server refused this with status ${status}.`;
}
