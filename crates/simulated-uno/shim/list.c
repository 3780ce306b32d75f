/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "list.h"

#include <stdlib.h>
#include <string.h>

#define INITIAL_CAPACITY 1024 /* items */

void list_push(struct list *list, const void *item)
{
	if (list->count == list->capacity) {
		list->capacity = list->capacity ? list->capacity * 2 : INITIAL_CAPACITY;
		list->items = realloc(list->items, list->capacity * list->item_size);
		if (!list->items)
			abort();
	}
	memcpy((char *)list->items + list->item_size * list->count++, item, list->item_size);
}

void serial_record_init(struct serial_record *record)
{
	*record = (struct serial_record){ .bytes.item_size = sizeof(struct serial_byte) };
}

void serial_record_push(struct serial_record *record, uint64_t cycle, uint8_t byte)
{
	list_push(&record->bytes, &(struct serial_byte){ cycle, byte });
	record->has_line_ended |= byte == '\n';
}
