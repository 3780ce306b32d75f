// Questions that arrive faster than they are answered, as while the user drags. Of the questions that arrive while
// one is being answered, only the last is kept; answers come in the order of their questions.

export class LatestQuestion<Question, Answer> {
  private next: Question | null = null;
  private isBusy = false;

  constructor(
    private readonly answer: (question: Question) => Promise<Answer>,
    private readonly onAnswer: (answer: Answer) => void,
  ) {}

  ask(question: Question): void {
    if (this.isBusy) this.next = question;
    else void this.begin(question);
  }

  private async begin(question: Question): Promise<void> {
    this.isBusy = true;
    this.next = null;
    const answer = await this.answer(question).finally(() => (this.isBusy = false));
    // The listener may ask again at once; that question replaces the waiting one.
    this.onAnswer(answer);
    if (this.next !== null && !this.isBusy) void this.begin(this.next);
  }
}
