// Servo pulses that are exact to the CPU cycle (62.5 ns), whatever serial traffic and other work a sketch has.
//
// The functions are those of Arduino's Servo library: to change over, include this file instead of Servo.h. The library
// drives one to eight servos on any pins except A6 and A7 of an ATmega328P at 16 MHz (UNO, Nano, Pro Mini). It uses
// Timer1, so pins 9 and 10 have no analogWrite. A frame, from one pulse of a servo to its next, lasts 22.5 ms.
#ifndef SERVO_PULSES_H
#define SERVO_PULSES_H

#include <Arduino.h>

#if !defined(__AVR_ATmega328P__) || F_CPU != 16000000L
#error "ServoPulses runs only on the ATmega328P at 16 MHz (UNO, Nano): choose such a board, or use the library Servo."
#endif

#define MIN_PULSE_WIDTH 544
#define MAX_PULSE_WIDTH 2400
#define DEFAULT_PULSE_WIDTH 1500
#define MAX_SERVOS 8
#define INVALID_SERVO 255

class Servo {
public:
  Servo();

  // Makes the pin an output and starts its pulses, with the last width written, or 1500 us. `min` and `max` are the
  // widths for 0 and 180 degrees in us, from 63 to 2437; every width is limited to this range. Returns the servo's
  // number, 0 to 7, or INVALID_SERVO for a ninth servo or a pin that the board does not have.
  uint8_t attach(int pin) { return attach(pin, MIN_PULSE_WIDTH, MAX_PULSE_WIDTH); }
  uint8_t attach(int pin, int min, int max);
  // Ends the pulses. A pulse that has begun, or is already planned, keeps its width. The pin stays an output and low.
  void detach();
  bool attached() const;

  // Sets the angle, 0 to 180 degrees. A value of at least MIN_PULSE_WIDTH is a width in us instead.
  void write(int value);
  void writeMicroseconds(int us);
  // Sets the width in CPU cycles of 62.5 ns, 16 in a microsecond.
  void writeCycles(uint16_t cycles);
  // Returns the angle for the present width, in degrees.
  int read() const;
  int readMicroseconds() const;

  // Returns the number of frames since the first `attach`, modulo 256. All widths that are written within 2.4 ms after
  // this number changes take effect together, in the next frame.
  static uint8_t frames();
  // Returns the number of edges that were late because interrupts were off, or another handler ran, for more than
  // 10 us. A pulse that would begin late is left out, since its width would be wrong. The count stops at 255.
  static uint8_t late();

private:
  // The servo's number, 0 to 7, or INVALID_SERVO.
  uint8_t number;
  uint16_t minUs = MIN_PULSE_WIDTH, maxUs = MAX_PULSE_WIDTH;
  uint16_t widthCycles = 16 * DEFAULT_PULSE_WIDTH;
};

#endif
