// An interrupt comes a varying number of cycles after its event. So each compare interrupt of Timer1 comes early, reads
// how late it is, waits for the rest of LEAD and only then stores the port. Both edges wait in the same instructions,
// hence every constant delay cancels and the width is exact. One pin is high at a time, each in a slot of its own; a
// ninth slot gives the sketch time for the next widths.
//
// The method, its rules and its proofs are those of the Rust crate servo-pulses; a test compares the edges of both.
#include "ServoPulses.h"

#include <util/atomic.h>

namespace {

// Cycles from a compare match to the moment after which the edge follows; at most 255.
const uint8_t LEAD = 220;
const uint16_t SLOT = 40000;
const uint16_t LONGEST = SLOT - 1000;
const uint16_t NO_PULSE = LONGEST + LEAD;

// The servos, by slot. A width of 0 makes no pulse.
volatile uint8_t *volatile ports[MAX_SERVOS];
volatile uint8_t masks[MAX_SERVOS];
volatile uint16_t widths[MAX_SERVOS];

// The slot under way or, between slots, the next: its number, its pin, and the count of the falling edge. Only the
// handlers use these.
uint8_t slot = MAX_SERVOS;
volatile uint8_t *port;
uint8_t mask;
uint16_t fall = NO_PULSE;

volatile uint8_t framesSoFar, lateSoFar;

inline __attribute__((always_inline)) void countLate() {
  if (lateSoFar != 255) lateSoFar++;
}

// Stores `low` in `port` a fixed number of cycles after Timer1 counts `count`, or at once if that is past. Sets the bits
// of `change` only if it is on time. Returns 0xff if it is on time, else 0.
inline __attribute__((always_inline)) uint8_t storeAt(uint16_t count, volatile uint8_t *port, uint8_t low, uint8_t change) {
  uint8_t left = count, onTime = count >> 8, now;
  asm volatile(
      // left = count - now
      "lds %[now], %[timer]\n"
      "sub %[left], %[now]\n"
      "lds %[now], %[timer]+1\n"
      "sbc %[onTime], %[now]\n"
      // The borrow says late.
      "sbc %[onTime], %[onTime]\n"
      "com %[onTime]\n"
      "and %[left], %[onTime]\n"
      "and %[change], %[onTime]\n"
      "or %[low], %[change]\n"
      // Three cycles a turn, and the rest by branches, which take one cycle or, if taken, two.
      "1: subi %[left], 3\n"
      "brcc 1b\n"
      "cpi %[left], 254\n"
      "brcc 2f\n"
      "2: cpi %[left], 255\n"
      "breq 3f\n"
      "3: st %a[port], %[low]\n"
      : [left] "+d"(left), [onTime] "+r"(onTime), [low] "+r"(low), [change] "+r"(change), [now] "=&r"(now)
      : [timer] "n"(_SFR_MEM_ADDR(TCNT1)), [port] "e"(port)
      : "memory");
  return onTime;
}

// Starts Timer1, once: it counts cycles up to the end of a slot. The first slot is the one without a pin.
void start() {
  if (TCCR1B == (_BV(WGM12) | _BV(CS10))) return;
  // The core has started it for analogWrite.
  TCCR1B = 0;
  TCCR1A = 0;
  TCNT1 = 0;
  OCR1A = SLOT - 1;
  OCR1B = 0xffff;
  TIFR1 = _BV(OCF1A) | _BV(OCF1B);
  TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
  TCCR1B = _BV(WGM12) | _BV(CS10);
}

void setWidth(uint8_t number, uint16_t cycles) {
  // Two bytes, and the handler may want them in between.
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { widths[number] = cycles; }
}

} // namespace

// A slot opens: raises its pin, or steps the frames.
ISR(TIMER1_COMPA_vect) {
  if (mask) {
    uint8_t before = *port;
    // A pin that is still high has missed its falling edge, and only goes down.
    uint8_t change = mask & ~before;
    if (!(storeAt(LEAD, port, before & ~mask, change) & change)) countLate();
  } else if (slot == MAX_SERVOS) {
    framesSoFar++;
  }
  OCR1B = fall - LEAD;
  // After a long time without interrupts, a match with an old count would close this slot at once.
  TIFR1 = _BV(OCF1B);
}

// A slot closes: lowers its pin and plans the next.
ISR(TIMER1_COMPB_vect) {
  if (mask && !storeAt(fall, port, *port & ~mask, 0)) countLate();
  slot = slot == MAX_SERVOS ? 0 : slot + 1;
  mask = 0;
  fall = NO_PULSE;
  if (slot == MAX_SERVOS) return;
  uint16_t width = widths[slot];
  if (!width) return;
  port = ports[slot];
  mask = masks[slot];
  fall = width + LEAD;
}

Servo::Servo() {
  static uint8_t made;
  number = made < MAX_SERVOS ? made++ : INVALID_SERVO;
}

uint8_t Servo::attach(int pin, int low, int high) {
  if (number == INVALID_SERVO || pin < 0 || pin >= NUM_DIGITAL_PINS) return INVALID_SERVO;
  detach();
  minUs = constrain(low, 63, int(LONGEST / 16));
  maxUs = constrain(high, 63, int(LONGEST / 16));
  volatile uint8_t *pinPort = portOutputRegister(digitalPinToPort(pin));
  uint8_t pinMask = digitalPinToBitMask(pin);
  bool hasPulse;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { hasPulse = mask == pinMask && port == pinPort; }
  // A pulse that was under way at `detach` keeps its width.
  if (!hasPulse) digitalWrite(pin, LOW);
  pinMode(pin, OUTPUT);
  writeCycles(widthCycles);
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    ports[number] = pinPort;
    masks[number] = pinMask;
    widths[number] = widthCycles;
    start();
  }
  return number;
}

void Servo::detach() {
  if (number != INVALID_SERVO) setWidth(number, 0);
}

bool Servo::attached() const { return number != INVALID_SERVO && widths[number]; }

void Servo::write(int value) {
  if (value < MIN_PULSE_WIDTH) value = map(constrain(value, 0, 180), 0, 180, minUs, maxUs);
  writeMicroseconds(value);
}

void Servo::writeMicroseconds(int us) { writeCycles(16u * constrain(us, (int)minUs, (int)maxUs)); }

void Servo::writeCycles(uint16_t value) {
  widthCycles = constrain(value, 16 * minUs, 16 * maxUs);
  if (attached()) setWidth(number, widthCycles);
}

int Servo::readMicroseconds() const { return widthCycles / 16; }

// One more, since `write` rounds down.
int Servo::read() const { return map(readMicroseconds() + 1, minUs, maxUs, 0, 180); }

uint8_t Servo::frames() { return framesSoFar; }

uint8_t Servo::late() { return lateSoFar; }
