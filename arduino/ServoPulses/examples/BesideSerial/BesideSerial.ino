// Eight servos hold still while the board echoes every byte that its serial port receives at 115200 baud. Send it a
// large file: the horns do not move. With <Servo.h> in place of <ServoPulses.h>, they jitter.
#include <ServoPulses.h>

const uint8_t PINS[8] = {2, 3, 7, 8, 9, 12, A0, A5};
Servo servos[8];

void setup() {
  Serial.begin(115200);
  for (uint8_t i = 0; i < 8; i++) {
    servos[i].attach(PINS[i]);
    servos[i].write(90);
  }
}

void loop() {
  if (Serial.available()) Serial.write(Serial.read());
}
