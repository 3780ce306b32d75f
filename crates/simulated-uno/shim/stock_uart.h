/* simavr's own USART0, used without corrections if the fidelity is `Stock`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_uart.h>

#include "instruction.h"
#include "sender.h"
#include "list.h"

struct stock_uart {
	avr_uart_t *simavr_uart;                /* simavr's USART0 */
	const struct instruction *instruction;  /* gives the cycle at which a byte is transmitted */
	struct serial_record *transmitted;       /* record of the transmitted bytes */
};

/* Switches off simavr's pauses and its echo to stdout, and records the transmitted bytes. */
void stock_uart_attach(struct stock_uart *uart, const struct instruction *instruction,
                       struct serial_record *transmitted);
/* Returns a receiver that passes the sender's bytes to this UART. */
struct receiver stock_uart_receiver(struct stock_uart *uart);
