/** What can become of a request. */
import type { Failure } from "../../messages";

/** A file for the person to keep. */
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

/** Whether a recording could not be read, and of which people one is to be chosen. */
export function notRead(error: unknown): string[] | null {
  const failure = error instanceof Refused ? (error.body as Partial<Failure> | null) : null;
  return failure?.reading ? (failure.people ?? []) : null;
}

/** Whether a recording is a video whose poses have to be estimated first. */
export function needsPoses(error: unknown): boolean {
  return error instanceof Refused && Boolean((error.body as Partial<Failure> | null)?.poses);
}

/** What to tell a person about anything thrown by this page. */
export function explain(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** The file name of a Content-Disposition header, its UTF-8 form first; empty if it has none. */
export function filename(disposition: string): string {
  const encoded = /filename\*=utf-8''([^;]+)/i.exec(disposition)?.[1];
  if (encoded) return decodeURIComponent(encoded);
  return /filename="?([^";]+)"?/i.exec(disposition)?.[1] ?? "";
}

/** What was asked for; null where there is no such thing. */
export async function orNull<T>(answer: Promise<T>): Promise<T | null> {
  try {
    return await answer;
  } catch (error) {
    if (error instanceof Refused && error.status === 404) return null;
    throw error;
  }
}

export async function unbroken<T>(work: Promise<T>): Promise<T> {
  try {
    return await work;
  } catch {
    throw new Unreachable();
  }
}

export function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

export function sentence(body: unknown, status: number): string {
  const error = (body as Partial<Failure> | null)?.error;
  return error ?? `The server refused this with status ${status}.`;
}
