/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "serial_bytes.h"

void serial_bytes_init(struct serial_bytes *bytes)
{
	*bytes = (struct serial_bytes){ .bytes.size = sizeof(struct serial_byte) };
}

void serial_bytes_push(struct serial_bytes *bytes, uint64_t cycle, uint8_t byte)
{
	struct serial_byte *last = list_push(&bytes->bytes);
	*last = (struct serial_byte){ cycle, byte };
	bytes->line_ended |= byte == '\n';
}

void serial_bytes_free(struct serial_bytes *bytes)
{
	list_free(&bytes->bytes);
}
