#include "page/figure.h"

struct number_table *table_new(struct pool *pool, int rows, int columns)
{
    struct number_table *table = POOL_NEW(pool, struct number_table);
    size_t cells = (size_t)rows * (size_t)columns;
    if (!table)
        return NULL;
    *table = (struct number_table){columns, rows, POOL_ARRAY(pool, const char *, columns), POOL_ARRAY(pool, const char *, cells),
                                   POOL_ARRAY(pool, char, columns)};
    if (!table->head || !table->cell || !table->look)
        return NULL;
    for (int j = 0; j < columns; j++)
        table->head[j] = "";
    for (size_t i = 0; i < cells; i++)
        table->cell[i] = "";
    return table;
}

struct number_table *table_headed(struct pool *pool, int rows, int columns, const char *const *head)
{
    struct number_table *table = table_new(pool, rows, columns);
    for (int j = 0; j < columns; j++)
        table_head(table, j, head[j]);
    return table;
}

void table_head(struct number_table *table, int column, const char *text)
{
    if (table)
        table->head[column] = text ? text : "";
}

void table_cell(struct number_table *table, int row, int column, const char *text)
{
    if (table)
        table->cell[row * table->columns + column] = text ? text : "";
}
