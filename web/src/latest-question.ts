// A queue of one for questions that may arrive faster than they are answered, for example while the user drags. Of the
// questions that arrive while one is being answered, only the last is kept; answers come in the order of their
// questions.

export class LatestQuestion<Question, Answer> {
  private waitingQuestion: Question | null = null;
  private isBusy = false;

  constructor(
    private readonly getAnswer: (question: Question) => Promise<Answer>,
    private readonly onAnswer: (answer: Answer) => void,
  ) {}

  /** Asks a question; it replaces the waiting one, if there is one. */
  ask(question: Question): void {
    if (this.isBusy) this.waitingQuestion = question;
    else void this.start(question);
  }

  private async start(question: Question): Promise<void> {
    this.isBusy = true;
    this.waitingQuestion = null;
    const answer = await this.getAnswer(question).finally(() => (this.isBusy = false));
    // The callback may ask again at once; that question replaces the waiting one.
    this.onAnswer(answer);
    if (this.waitingQuestion !== null && !this.isBusy) void this.start(this.waitingQuestion);
  }
}
