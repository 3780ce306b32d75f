// Questions for a worker that arrive faster than it answers, as while the user drags. Of the questions that arrive
// while it works, only the last is answered, and answers come in the order of their questions.

export class LatestQuestion<Question, Answer> {
  private readonly worker: Worker;
  private next: Question | null = null;
  private isBusy = false;

  /** Sends the module of the robot first, then one question at a time. */
  constructor(worker: Worker, module: WebAssembly.Module, onAnswer: (answer: Answer) => void) {
    this.worker = worker;
    worker.postMessage(module);
    worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      this.isBusy = false;
      // The listener may ask again at once; that question replaces the waiting one.
      onAnswer(data);
      if (this.next !== null && !this.isBusy) this.ask(this.next);
    });
  }

  ask(question: Question): void {
    this.next = this.isBusy ? question : null;
    if (this.isBusy) return;
    this.isBusy = true;
    this.worker.postMessage(question);
  }
}
