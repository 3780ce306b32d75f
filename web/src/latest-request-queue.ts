// A queue of length one for requests that may arrive faster than their responses, for example while the user drags a
// slider. While a request is pending, only the latest new request is kept; responses arrive in the order of the
// requests.

export class LatestRequestQueue<Query, Answer> {
  private queuedRequest: Query | null = null;
  private isBusy = false;

  constructor(
    private readonly getResponse: (request: Query) => Promise<Answer>,
    private readonly onResponse: (response: Answer) => void,
    private readonly onError: (error: unknown) => void,
  ) {}

  /** Sends a request at once or, while another request is pending, queues it in place of the queued request. */
  submit(request: Query): void {
    if (this.isBusy) this.queuedRequest = request;
    else void this.send(request);
  }

  private async send(request: Query): Promise<void> {
    this.isBusy = true;
    this.queuedRequest = null;
    try {
      const response = await this.getResponse(request).finally(() => (this.isBusy = false));
      // The callback may submit another request, which replaces the queued request.
      this.onResponse(response);
    } catch (error) {
      this.onError(error);
    }
    if (this.queuedRequest !== null && !this.isBusy) void this.send(this.queuedRequest);
  }
}
