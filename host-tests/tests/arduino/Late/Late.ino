// Blocks interrupts for 30 us at a time, longer than the library allows. Lights the LED once a late edge is counted.
#include <ServoPulses.h>

Servo servo;

void setup() {
  pinMode(13, OUTPUT);
  servo.attach(9);
}

void loop() {
  noInterrupts();
  delayMicroseconds(30);
  interrupts();
  delayMicroseconds(27);
  digitalWrite(13, Servo::lateEdgeCount() > 0);
}
