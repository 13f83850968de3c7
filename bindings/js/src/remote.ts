/** A worker of a browser, or of Node.js, which has `on`. */
type AnyWorker = Worker & { on?(event: string, listener: (value: any) => void): AnyWorker };

/** A worker with its unanswered calls, which it answers in order. */
export class Remote<Reply extends { error?: string }> {
  #worker: AnyWorker;
  #calls: { resolve: (reply: Reply) => void; reject: (error: Error) => void }[] = [];
  /** The failure of the worker, after which it answers no more calls. */
  #failure: Error | undefined;

  /** @param describe Returns the message of calls that a failure of the worker ends. */
  constructor(worker: AnyWorker, describe: (message?: string) => string) {
    this.#worker = worker;
    const receive = (reply: Reply) => {
      const call = this.#calls.shift();
      if (reply.error === undefined) call?.resolve(reply);
      else call?.reject(new Error(reply.error));
    };
    const fail = ({ message }: { message?: string }) => this.#fail(describe(message));
    worker.on?.("message", receive).on!("error", fail).on!("exit", () => fail({ message: "it has ended" }));
    worker.onmessage = ({ data }) => receive(data);
    worker.onerror = fail;
  }

  ask(message: unknown): Promise<Reply> {
    if (this.#failure) return Promise.reject(this.#failure);
    return new Promise((resolve, reject) => {
      this.#calls.push({ resolve, reject });
      this.#worker.postMessage(message);
    });
  }

  /** Ends the worker, and rejects calls with a message. */
  end(message: string): void {
    this.#fail(message);
    this.#worker.terminate();
  }

  /** Rejects all pending and later calls, because a worker that has ended never answers them. */
  #fail(message: string): void {
    this.#failure ??= new Error(message);
    for (const { reject } of this.#calls.splice(0)) reject(this.#failure);
  }
}
