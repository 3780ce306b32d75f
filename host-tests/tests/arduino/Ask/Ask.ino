// Prints attach() plus attached() for each of nine servos, and attach() for a pin that does not exist. Then writes
// every number that it receives to a servo, and prints the angle and the width that it reads back.
#include <ServoPulses.h>

Servo servos[9];

void setup() {
  Serial.begin(115200);
  Serial.setTimeout(5);
  servos[0].write(0);
  for (uint8_t i = 0; i < 9; i++) Serial.print(servos[i].attach(i + 2) + servos[i].attached());
  Serial.println(servos[1].attach(20));
  for (uint8_t i = 1; i < 8; i++) servos[i].detach();
  servos[0].attach(2, 1000, 2000);
}

void loop() {
  if (!Serial.available()) return;
  servos[0].write(Serial.parseInt());
  Serial.read();       // discards the line end
  servos[1].write(90); // has no effect, since this servo is detached
  Serial.print(servos[0].read());
  Serial.print(' ');
  Serial.println(servos[0].readMicroseconds());
}
