/* An oscilloscope on the board: records every edge of D2 to D13 and A0 to A5, and every store to
 * GPIOR0, with which the firmware can mark an event.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"
#include "list.h"

struct edge { uint64_t cycle; uint8_t pin, level; }; /* `pin`: Arduino number; `level`: new level */
struct mark { uint64_t cycle; uint8_t value; };

struct recorder;
struct recorded_pin { struct recorder *recorder; uint8_t number; }; /* `number`: Arduino number */

struct recorder {
	const struct instruction *instruction;
	struct recorded_pin pins[CHIP_PIN_COUNT];
	uint32_t levels;    /* levels of the recorded pins, bit n = Arduino pin n */
	struct list edges;  /* struct edge */
	struct list marks;  /* struct mark */
};

void recorder_attach(struct recorder *recorder, const struct instruction *instruction);
/* Records every pin as low: a reset makes all pins inputs. */
void recorder_release_pins(struct recorder *recorder);
