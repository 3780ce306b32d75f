// Servo pulses that are exact to the CPU cycle (62.5 ns), even during serial traffic and other work of the sketch.
//
// The library has the functions of Arduino's Servo library: to switch, include this file instead of Servo.h. It drives
// one to eight servos on any pins except A6 and A7 of an ATmega328P at 16 MHz (UNO, Nano, Pro Mini). It uses Timer1, so
// analogWrite does not work on pins 9 and 10. Each servo gets one pulse in a frame, which lasts 22.5 ms.
#ifndef SERVO_PULSES_H
#define SERVO_PULSES_H

#include <Arduino.h>

#if !defined(__AVR_ATmega328P__) || F_CPU != 16000000L
#error "ServoPulses requires an ATmega328P at 16 MHz (UNO, Nano): choose such a board, or use the Servo library."
#endif

#define MIN_PULSE_WIDTH 544
#define MAX_PULSE_WIDTH 2400
#define DEFAULT_PULSE_WIDTH 1500
#define MAX_SERVOS 8
#define INVALID_SERVO 255

class Servo {
public:
  Servo();

  // Makes the pin an output and starts its pulses, with the last written width or 1500 us. `min` and `max` are the
  // widths for 0 and 180 degrees. They are clamped to 63 to 2437 us, and every width is clamped to `min` to `max`.
  // Returns the servo's number, 0 to 7, or INVALID_SERVO for a ninth servo or an invalid pin.
  uint8_t attach(int pin) { return attach(pin, MIN_PULSE_WIDTH, MAX_PULSE_WIDTH); }
  uint8_t attach(int pin, int min, int max);
  // Stops the pulses. A pulse that has begun or is already planned keeps its width. The pin remains an output, low.
  void detach();
  bool attached() const;

  // Sets the angle, 0 to 180 degrees. A value of at least MIN_PULSE_WIDTH is a width in us instead.
  void write(int value);
  void writeMicroseconds(int us);
  // Sets the width in CPU cycles of 62.5 ns, 16 in 1 us.
  void writeCycles(uint16_t cycles);
  // Returns the angle of the current width, in degrees.
  int read() const;
  int readMicroseconds() const;

  // Returns the number of frames since the first `attach`, modulo 256. Widths that are all written within 2.4 ms
  // after a change of this number take effect together, in the next frame.
  static uint8_t frameCount();
  // Returns the number of edges that were late because interrupts were blocked for more than 10 us. A pulse that would
  // begin late is omitted, since its width would be wrong. The count stops at 255.
  static uint8_t lateEdgeCount();

private:
  // The servo's number, 0 to 7, or INVALID_SERVO.
  uint8_t number;
  uint16_t minUs = MIN_PULSE_WIDTH, maxUs = MAX_PULSE_WIDTH;
  uint16_t widthCycles = 16 * DEFAULT_PULSE_WIDTH;
};

#endif
