/* The EEPROM by the ATmega328P's data sheet, 8.4 and 8.6.
 *
 * simavr 1.6 stores a byte at once, never reads busy, and knows no erase-only
 * or write-only mode. Here a byte takes 3.4 or 1.8 ms, the EEPROM Ready
 * interrupt is a level, the CPU stands still for 4 cycles when it reads and 2
 * when it writes, and a power cut leaves a byte torn.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_eeprom.h>

#include "instruction.h"
#include "interrupts.h"
#include "list.h"
#include "reset.h"

/* EEPM1:0. Kept in step with `EepromMode` in src/eeprom.rs. */
enum eeprom_mode { EEPROM_ERASE_WRITE, EEPROM_ERASE, EEPROM_WRITE };

struct eeprom_operation {
	uint64_t cycle;      /* at which it started */
	uint16_t address;
	uint8_t mode;        /* enum eeprom_mode */
	uint8_t old, stored; /* the byte before and after */
	uint8_t torn;        /* 1 if a power cut ended it */
};

struct eeprom_cut { bool on; uint64_t skip; bool in_write; };

struct eeprom {
	avr_t *avr;
	const struct instruction *instruction;
	struct interrupts *interrupts;
	struct reset *reset;
	avr_eeprom_t *stock;       /* simavr's, which keeps the bytes */
	uint64_t armed_until;      /* last cycle at which EEPE may be written */
	bool busy;
	uint64_t start, end, cut;  /* cycles of the operation in progress; 0: no cut */
	uint8_t target;            /* EEDR at its start */
	struct eeprom_cut ask;     /* power cut in a later operation */
	uint8_t torn_ones;         /* bits of a torn byte that are still, or already, one */
	struct list operations;    /* struct eeprom_operation */
};

/* Finds simavr's bytes; there is no more in the stock fidelity. */
void eeprom_attach(struct eeprom *eeprom, avr_t *avr);
/* Replaces simavr's handlers of its registers. */
void eeprom_correct(struct eeprom *eeprom, const struct instruction *instruction,
                    struct interrupts *interrupts, struct reset *reset);
/* "If a reset occurs while a write operation is in progress, the write
 * operation will be completed" (8.4.2). */
void eeprom_reset(struct eeprom *eeprom);
/* The supply fails: an operation in progress leaves a torn byte. */
void eeprom_tear(struct eeprom *eeprom);
/* Cancels a power cut that has not happened. */
void eeprom_keep_power(struct eeprom *eeprom);
void eeprom_free(struct eeprom *eeprom);
