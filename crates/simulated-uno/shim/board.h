/* The parts of a simulated UNO. Private to uno.c, restart.c and chip_access.c.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "adc.h"
#include "call_timer.h"
#include "contacts.h"
#include "disturbance.h"
#include "eeprom.h"
#include "instruction.h"
#include "interrupts.h"
#include "pin_toggle.h"
#include "recorder.h"
#include "reset.h"
#include "sender.h"
#include "stock_uart.h"
#include "supply.h"
#include "timer1.h"
#include "uno.h"
#include "usart.h"
#include "watchdog.h"

struct uno {
	avr_t *avr;               /* simavr's model of the chip */
	avr_io_t io;              /* our entry at the end of simavr's list of parts to reset */
	bool follows_data_sheet;  /* true: behaves as in the data sheet; false: as stock simavr */

	uint64_t now;             /* current cycle; ahead of avr->cycle only while the CPU sleeps */
	uint64_t sleep_cycles;    /* cycles up to avr->cycle in which the CPU slept */
	uint64_t watchdog_reset_count; /* resets by the watchdog so far */
	bool is_powered_off;      /* true from a power cut until the power is restored */
	uint16_t data_end;        /* first SRAM address after the firmware's static data */
	char error_message[256];  /* the last error that simavr logged; empty if none */

	/* Parts of both fidelities. */
	struct instruction instruction;  /* the instruction being executed */
	struct recorder recorder;        /* edges of the pins, and marks in GPIOR0 */
	struct handlers handlers;        /* cycles spent in interrupt handlers */
	struct call_timer call_timer;    /* times the calls of one function */
	struct serial_record transmitted; /* bytes that the firmware has sent */
	struct stock_uart stock_uart;    /* simavr's USART; receives only in the stock fidelity */
	struct sender sender;            /* the other end of the serial cable */
	struct disturbance disturbance;  /* interrupts and stalls imposed by a test */
	struct reset reset;              /* requested resets, and MCUSR */
	struct supply supply;            /* VCC; resets the chip only in the data-sheet fidelity */
	struct eeprom eeprom;            /* in the stock fidelity, only gives access to simavr's bytes */
	struct adc adc;                  /* in the stock fidelity, only sets the voltages at the pins */
	struct contacts contacts;        /* contacts between pins and ground */

	/* Corrections according to the data sheet; not attached in the stock fidelity. */
	struct interrupts interrupts;    /* entry times and flags of interrupts */
	struct timer1 timer1;            /* the TEMP byte of Timer1's 16-bit registers */
	struct pin_toggle pin_toggle;    /* `sbi PINx, n` toggles one pin */
	struct usart usart;              /* USART0 with its real buffers and frame length */
	struct watchdog watchdog;        /* the watchdog's modes and timed sequence */
};
