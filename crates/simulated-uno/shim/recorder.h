/* An oscilloscope on the board: records every edge of the chosen pins and every store to GPIOR0, with
 * which the firmware can mark an event.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"
#include "list.h"

struct edge { uint64_t cycle; uint8_t pin, level; }; /* `pin`: Arduino number; `level`: new level */
struct mark { uint64_t cycle; uint8_t value; };

struct recorder;
struct recorded_port {
	struct recorder *recorder;
	char name;          /* 'B', 'C' or 'D' */
	uint8_t first_pin;  /* Arduino number of the port's bit 0 */
	uint8_t pin_count;  /* number of the port's pins on the board */
};

struct recorder {
	const struct instruction *instruction;
	struct recorded_port ports[3];
	uint32_t pins;      /* recorded pins, bit n = Arduino pin n */
	uint32_t levels;    /* levels of the recorded pins, bit n = Arduino pin n */
	struct list edges;  /* struct edge */
	struct list marks;  /* struct mark */
};

void recorder_attach(struct recorder *recorder, const struct instruction *instruction,
                     uint32_t pins);
/* Records every pin as low: a reset makes all pins inputs. */
void recorder_release_pins(struct recorder *recorder);
