/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "list.h"

#include <stdlib.h>

void *list_push(struct list *list)
{
	if (list->count == list->room) {
		list->room = list->room ? list->room * 2 : 1024;
		list->items = realloc(list->items, list->room * list->size);
		if (!list->items)
			abort();
	}
	return (char *)list->items + list->size * list->count++;
}

void list_free(struct list *list)
{
	free(list->items);
	*list = (struct list){ .size = list->size };
}

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
