// Interrupts are off for 30 us at a time, longer than the library bears. The LED shows that it has counted late edges.
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
  digitalWrite(13, Servo::late() > 0);
}
