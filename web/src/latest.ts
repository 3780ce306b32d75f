// Questions for a worker that come faster than it answers, as while a person drags: of those that are asked while it is
// at work, only the last is answered, and no answer comes after that of a later question.

export class Latest<Question, Answer> {
  private readonly worker: Worker;
  private next: Question | null = null;
  private isBusy = false;

  /** The worker gets the module of the robot first, and then one question at a time. */
  constructor(worker: Worker, module: WebAssembly.Module, onAnswer: (answer: Answer) => void) {
    this.worker = worker;
    worker.postMessage(module);
    worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => {
      this.isBusy = false;
      // Whoever hears the answer may ask at once, and that is then the later question.
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
