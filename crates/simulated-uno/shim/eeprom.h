/* The EEPROM according to the ATmega328P's data sheet, 8.4 and 8.6.
 *
 * simavr 1.6 stores a byte at once, is never busy, and has no erase-only or write-only mode. Here a
 * byte takes 3.4 or 1.8 ms, the EEPROM Ready interrupt is level-triggered, the CPU is halted for 4
 * cycles after a read and 2 cycles after a write, and a power cut tears the byte in progress.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_eeprom.h>

#include "interrupts.h"
#include "list.h"
#include "reset.h"

/* EEPM1:0. Must match `EepromMode` in src/eeprom.rs. */
enum eeprom_mode { EEPROM_ERASE_WRITE, EEPROM_ERASE, EEPROM_WRITE };

struct eeprom_operation {
	uint64_t cycle;    /* cycle at which the operation started */
	uint16_t address;  /* address of the byte */
	uint8_t mode;      /* enum eeprom_mode */
	uint8_t old_value; /* the byte before the operation */
	uint8_t new_value; /* the byte after the operation */
	uint8_t is_torn;   /* 1 if a power cut ended the operation */
};

/* A request to cut the power during a later operation. */
struct eeprom_cut_request {
	bool is_pending;
	uint64_t skip_count; /* number of operations to skip before the cut */
	bool in_write;       /* true: in the write phase; false: in the erase phase */
};

struct eeprom {
	avr_t *avr;
	struct interrupts *interrupts;
	struct reset *reset;
	avr_eeprom_t *stock;       /* simavr's EEPROM, which keeps the bytes */
	uint64_t armed_until;      /* last cycle at which setting EEPE starts an operation */
	bool is_busy;              /* an operation is in progress */
	uint64_t cut_at;           /* cycle at which a power cut tears the byte; 0: never */
	uint8_t written_data;      /* EEDR when the operation started */
	struct eeprom_cut_request cut_request;
	uint8_t torn_bits;         /* bits set in a torn byte in addition to its old or new value */
	struct list operations;    /* all operations so far: struct eeprom_operation */
};

/* Gives access to simavr's bytes, which is sufficient for the stock fidelity. */
void eeprom_attach(struct eeprom *eeprom, avr_t *avr);
/* Replaces simavr's callbacks for the EEPROM's registers. */
void eeprom_correct(struct eeprom *eeprom, struct interrupts *interrupts, struct reset *reset);
/* "If a reset occurs while a write operation is in progress, the write
 * operation will be completed" (8.4.2). */
void eeprom_reset(struct eeprom *eeprom);
/* Ends an operation in progress with a torn byte; must be called when the supply fails. */
void eeprom_tear(struct eeprom *eeprom);
/* Cancels a power cut in an operation that has not happened yet. */
void eeprom_cancel_cut(struct eeprom *eeprom);
