/* The parts of one simulated UNO. Private to uno.c, restart.c and chip_access.c.
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
	avr_t *avr;
	avr_io_t io;            /* our place in simavr's reset chain */
	bool data_sheet;

	uint64_t now;           /* time reached; ahead of avr->cycle only while asleep */
	uint64_t asleep;        /* cycles spent asleep */
	uint64_t resets;        /* resets by the watchdog */
	bool off;               /* the power has been cut */
	bool stop_at_line;
	uint16_t data_end;      /* first SRAM address after static data */
	char message[256];      /* simavr's last complaint */

	struct instruction instruction;
	struct recorder recorder;
	struct handlers handlers;
	struct call_timer call_timer;
	struct serial_bytes transmitted;
	struct stock_uart stock_uart;
	struct sender sender;
	struct disturbance disturbance;
	struct reset reset;
	struct supply supply;   /* the stock fidelity keeps VCC here */
	struct eeprom eeprom;   /* and the list of no operations */
	struct adc adc;
	struct contacts contacts;

	/* Corrections by the data sheet; idle in the stock fidelity. */
	struct interrupts interrupts;
	struct timer1 timer1;
	struct pin_toggle pin_toggle;
	struct usart usart;
	struct watchdog watchdog;
};
