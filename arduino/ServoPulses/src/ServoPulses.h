// Servo pulses, exact to the CPU cycle (62.5 ns), beside serial traffic and whatever else a sketch does.
//
// The functions are those of Arduino's Servo library: replace its #include by that of this file. ATmega328P at 16 MHz
// (UNO, Nano, Pro Mini), one to eight servos on any pins but A6 and A7. It takes Timer1, so pins 9 and 10 have no
// analogWrite. A frame, from one pulse of a servo to its next, has 22.5 ms.
#ifndef SERVO_PULSES_H
#define SERVO_PULSES_H

#include <Arduino.h>

#if !defined(__AVR_ATmega328P__) || F_CPU != 16000000L
#error "ServoPulses runs on the ATmega328P at 16 MHz alone (UNO, Nano): choose such a board, or use the library Servo."
#endif

#define MIN_PULSE_WIDTH 544
#define MAX_PULSE_WIDTH 2400
#define DEFAULT_PULSE_WIDTH 1500
#define MAX_SERVOS 8
#define INVALID_SERVO 255

class Servo {
public:
  Servo();

  // Makes the pin an output and starts its pulses, of 1500 us or the last width written. `min` and `max`, us, are the
  // widths of 0 and 180 degrees and bound all others; at least 63, at most 2437. Returns the servo's number, 0 to 7;
  // INVALID_SERVO for a ninth servo, or a pin that the board does not have.
  uint8_t attach(int pin) { return attach(pin, MIN_PULSE_WIDTH, MAX_PULSE_WIDTH); }
  uint8_t attach(int pin, int min, int max);
  // Ends the pulses; one that is under way or next keeps its width. The pin stays an output, low.
  void detach();
  bool attached() const;

  // Sets the angle, 0 to 180 degrees. From MIN_PULSE_WIDTH on, the value is a width in us.
  void write(int value);
  void writeMicroseconds(int us);
  // Sets the width in CPU cycles of 62.5 ns, 16 in a microsecond.
  void writeCycles(uint16_t cycles);
  // The angle of the present width, degrees.
  int read() const;
  int readMicroseconds() const;

  // Frames since the first `attach`, modulo 256. What is written within 2.4 ms after it steps begins together, in the
  // next frame.
  static uint8_t frames();
  // Edges that were late because interrupts were off, or another handler ran, for more than 10 us. A pulse that would
  // begin late is left out, since its width would be wrong. Stays at 255.
  static uint8_t late();

private:
  uint8_t number;
  uint16_t min = MIN_PULSE_WIDTH, max = MAX_PULSE_WIDTH;
  uint16_t cycles = 16 * DEFAULT_PULSE_WIDTH;
};

#endif
