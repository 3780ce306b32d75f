/* An oscilloscope on the board: records every edge of the pins that it is connected to,
 * and every store to GPIOR0, which firmware may use as a mark.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"
#include "list.h"

struct edge { uint64_t cycle; uint8_t pin, level; }; /* pin: Arduino number */
struct mark { uint64_t cycle; uint8_t value; };

struct recorder;
struct recorded_port {
	struct recorder *recorder;
	char name;          /* 'B', 'C' or 'D' */
	uint8_t first, bits; /* Arduino number of its bit 0; its pins on the board */
};

struct recorder {
	const struct instruction *instruction;
	struct recorded_port ports[3];
	uint32_t pins;      /* recorded pins, bit n = Arduino pin n */
	uint32_t levels;    /* of these, the ones that are high */
	struct list edges;  /* struct edge */
	struct list marks;  /* struct mark */
};

void recorder_attach(struct recorder *recorder, const struct instruction *instruction,
                     uint32_t pins);
/* Every recorded pin that is high goes low: a reset makes all pins inputs. */
void recorder_release_pins(struct recorder *recorder);
void recorder_free(struct recorder *recorder);
