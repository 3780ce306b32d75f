// Eight servos sweep from 1000 to 2000 us and back, each at its own speed, by one step per frame. Give them their own
// supply, whose negative terminal is connected to the board's GND.
#include <ServoPulses.h>

const uint8_t PINS[8] = {2, 3, 7, 8, 9, 12, A0, A5};
Servo servos[8];
uint8_t lastFrame;
uint16_t frame;

void setup() {
  for (uint8_t i = 0; i < 8; i++) servos[i].attach(PINS[i]);
}

void loop() {
  if (Servo::frameCount() == lastFrame) return;
  lastFrame = Servo::frameCount();
  for (uint8_t i = 0; i < 8; i++) {
    uint16_t ramp = uint16_t(frame * (16 * i + 5)) % 32000;
    servos[i].writeCycles(16000 + (ramp < 16000 ? ramp : 32000 - ramp));
  }
  frame++;
}
