// Writes the width of one servo as often as possible, with values that differ in both bytes, and attaches and detaches
// another servo.
#include <ServoPulses.h>

Servo written, attached;

void setup() {
  Serial.begin(115200);
  written.attach(9);
}

void loop() {
  written.writeCycles(0x5dff);
  attached.attach(A0);
  if (Serial.available()) Serial.write(Serial.read());
  written.writeCycles(0x5e00);
  attached.detach();
}
