// Four servos hold still while the board echoes whatever its serial line, 115200 baud, receives. Send it a large file:
// the horns do not move. With <Servo.h> in place of <ServoPulses.h> they tremble.
#include <ServoPulses.h>

const uint8_t PINS[4] = {9, 10, 11, 3};
Servo servos[4];

void setup() {
  Serial.begin(115200);
  for (uint8_t i = 0; i < 4; i++) {
    servos[i].attach(PINS[i]);
    servos[i].write(90);
  }
}

void loop() {
  if (Serial.available()) Serial.write(Serial.read());
}
