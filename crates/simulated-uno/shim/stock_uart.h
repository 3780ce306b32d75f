/* simavr's own USART0, as the stock fidelity uses it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_uart.h>

#include "instruction.h"
#include "sender.h"
#include "list.h"

struct stock_uart {
	avr_uart_t *uart;                       /* simavr's USART0 */
	const struct instruction *instruction;
	struct serial_bytes *transmitted;       /* record of the transmitted bytes */
};

/* Switches off simavr's pauses and its echo to stdout, and records the transmitted bytes. */
void stock_uart_attach(struct stock_uart *stock, const struct instruction *instruction,
                       struct serial_bytes *transmitted);
/* Returns the UART as the receiver at the end of the sender's cable. */
struct receiver stock_uart_receiver(struct stock_uart *stock);
