// An interrupt handler starts a varying number of cycles after its event. So each compare interrupt of Timer1 occurs
// early; its handler reads its own latency from the timer, waits for the rest of LEAD_CYCLES and only then stores to
// the port. Both edges wait in the same instructions, so every constant delay cancels and the width is exact. One pin
// is high at a time, each in its own slot; a ninth slot gives the sketch time for the next widths.
//
// The method and its rules are those of the Rust crate servo-pulses; a test compares the edges of both.
#include "ServoPulses.h"

#include <util/atomic.h>

namespace {

// Cycles from a compare match until the handler stops waiting; the edge follows after a fixed time. At most 255.
const uint8_t LEAD_CYCLES = 220;
const uint16_t SLOT_CYCLES = 40000; // 2.5 ms
const uint16_t MAX_WIDTH_CYCLES = SLOT_CYCLES - 1000;
const uint16_t NO_PULSE_COUNT = MAX_WIDTH_CYCLES + LEAD_CYCLES; // `fallCount` of a slot without a pulse

// The pins of the servos, and the widths of their pulses in cycles, by slot. A width of 0 results in no pulse.
volatile uint8_t *volatile ports[MAX_SERVOS];
volatile uint8_t masks[MAX_SERVOS];
volatile uint16_t widths[MAX_SERVOS];

// The current slot or, between slots, the next one: its number, its pin, and the timer count of the falling edge. Only
// the handlers change these.
uint8_t slot = MAX_SERVOS;
volatile uint8_t *port;
uint8_t mask;
uint16_t fallCount = NO_PULSE_COUNT;

volatile uint8_t frameCount, lateEdgeCount;

inline __attribute__((always_inline)) void countLateEdge() {
  if (lateEdgeCount != 255) lateEdgeCount++;
}

// Stores `base | setMask` in `port` a fixed number of cycles after Timer1 reaches `count`, and returns 0xff. If this
// count has passed, stores `base` at once and returns 0.
inline __attribute__((always_inline)) uint8_t storeAt(uint16_t count, volatile uint8_t *port, uint8_t base, uint8_t setMask) {
  uint8_t remaining = count, onTime = count >> 8, now;
  asm volatile(
      // remaining = count - now
      "lds %[now], %[timer]\n"
      "sub %[remaining], %[now]\n"
      "lds %[now], %[timer]+1\n"
      "sbc %[onTime], %[now]\n"
      // A borrow means that the edge is late.
      "sbc %[onTime], %[onTime]\n"
      "com %[onTime]\n"
      "and %[remaining], %[onTime]\n"
      "and %[setMask], %[onTime]\n"
      "or %[base], %[setMask]\n"
      // Three cycles per iteration, and the rest by branches, which take one cycle or, if taken, two.
      "1: subi %[remaining], 3\n"
      "brcc 1b\n"
      "cpi %[remaining], 254\n"
      "brcc 2f\n"
      "2: cpi %[remaining], 255\n"
      "breq 3f\n"
      "3: st %a[port], %[base]\n"
      : [remaining] "+d"(remaining), [onTime] "+r"(onTime), [base] "+r"(base), [setMask] "+r"(setMask), [now] "=&r"(now)
      : [timer] "n"(_SFR_MEM_ADDR(TCNT1)), [port] "e"(port)
      : "memory");
  return onTime;
}

// Starts Timer1, once, which counts cycles up to the end of a slot. The first slot is the one without a pin.
void start() {
  if (TCCR1B == (_BV(WGM12) | _BV(CS10))) return;
  // The Arduino core has started the timer for analogWrite.
  TCCR1B = 0;
  TCCR1A = 0;
  TCNT1 = 0;
  OCR1A = SLOT_CYCLES - 1;
  OCR1B = 0xffff;
  TIFR1 = _BV(OCF1A) | _BV(OCF1B);
  TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
  TCCR1B = _BV(WGM12) | _BV(CS10);
}

void setWidth(uint8_t number, uint16_t cycles) {
  // An interrupt between the two stores would read a wrong width.
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { widths[number] = cycles; }
}

} // namespace

// Opens a slot: raises its pin or, in the slot without a pin, counts a frame.
ISR(TIMER1_COMPA_vect) {
  if (mask) {
    uint8_t levels = *port;
    // A pin that is still high has missed its falling edge and may only go low.
    uint8_t setMask = mask & ~levels;
    if (!(storeAt(LEAD_CYCLES, port, levels & ~mask, setMask) & setMask)) countLateEdge();
  } else if (slot == MAX_SERVOS) {
    frameCount++;
  }
  OCR1B = fallCount - LEAD_CYCLES;
  // After a long time with interrupts off, a match with an old count would close this slot at once.
  TIFR1 = _BV(OCF1B);
}

// Closes a slot: lowers its pin and plans the next slot.
ISR(TIMER1_COMPB_vect) {
  if (mask && !storeAt(fallCount, port, *port & ~mask, 0)) countLateEdge();
  slot = slot == MAX_SERVOS ? 0 : slot + 1;
  mask = 0;
  fallCount = NO_PULSE_COUNT;
  if (slot == MAX_SERVOS) return;
  uint16_t width = widths[slot];
  if (!width) return;
  port = ports[slot];
  mask = masks[slot];
  fallCount = width + LEAD_CYCLES;
}

Servo::Servo() {
  static uint8_t servoCount;
  number = servoCount < MAX_SERVOS ? servoCount++ : INVALID_SERVO;
}

uint8_t Servo::attach(int pin, int min, int max) {
  if (number == INVALID_SERVO || pin < 0 || pin >= NUM_DIGITAL_PINS) return INVALID_SERVO;
  detach();
  minUs = constrain(min, 63, int(MAX_WIDTH_CYCLES / 16));
  maxUs = constrain(max, 63, int(MAX_WIDTH_CYCLES / 16));
  volatile uint8_t *pinPort = portOutputRegister(digitalPinToPort(pin));
  uint8_t pinMask = digitalPinToBitMask(pin);
  bool hasPulse;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { hasPulse = mask == pinMask && port == pinPort; }
  // A pulse that had begun before `detach` keeps its width.
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

void Servo::writeCycles(uint16_t cycles) {
  widthCycles = constrain(cycles, 16 * minUs, 16 * maxUs);
  if (attached()) setWidth(number, widthCycles);
}

int Servo::readMicroseconds() const { return widthCycles / 16; }

// One microsecond is added, because `write` rounds down.
int Servo::read() const { return map(readMicroseconds() + 1, minUs, maxUs, 0, 180); }

uint8_t Servo::frameCount() { return ::frameCount; }

uint8_t Servo::lateEdgeCount() { return ::lateEdgeCount; }
