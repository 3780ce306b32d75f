// A servo on pin 9 follows a potentiometer whose ends are on 5V and GND and whose wiper is on A0.
#include <ServoPulses.h>

Servo servo;

void setup() { servo.attach(9); }

void loop() {
  servo.write(map(analogRead(A0), 0, 1023, 0, 180));
  delay(15);
}
