/**
 * Share the token between tabs. A restarted server has a new token, known to the tab it opens.
 * Older tabs, which may hold unsent edits, continue with it.
 */
import { writeToken } from "./address";
import { Api, Refused } from "./api";

/** Send this tab's token to other tabs and take over theirs if its own is no longer valid. */
export function shareToken(api: Api): void {
  const channel = new BroadcastChannel("kineme.token");
  const isGood = (token: string): Promise<boolean> =>
    new Api(token)
      .loadState()
      .then(() => true)
      .catch((error: unknown) => !(error instanceof Refused));
  channel.onmessage = async ({ data: token }: MessageEvent<string>) => {
    if (token === api.token || (await isGood(api.token)) || !(await isGood(token))) return;
    api.token = token;
    writeToken(token);
  };
  channel.postMessage(api.token);
}
