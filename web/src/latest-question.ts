// A queue of length one for questions that may arrive faster than their answers, for example while the user drags.
// While a question is being answered, only the latest new question is kept; answers arrive in the order of the
// questions.

export class LatestQuestion<Question, Answer> {
  private waitingQuestion: Question | null = null;
  private isBusy = false;

  constructor(
    private readonly getAnswer: (question: Question) => Promise<Answer>,
    private readonly onAnswer: (answer: Answer) => void,
  ) {}

  /** Asks a question, which replaces the waiting question. */
  ask(question: Question): void {
    if (this.isBusy) this.waitingQuestion = question;
    else void this.start(question);
  }

  private async start(question: Question): Promise<void> {
    this.isBusy = true;
    this.waitingQuestion = null;
    const answer = await this.getAnswer(question).finally(() => (this.isBusy = false));
    // The callback may ask another question, which replaces the waiting question.
    this.onAnswer(answer);
    if (this.waitingQuestion !== null && !this.isBusy) void this.start(this.waitingQuestion);
  }
}
