#pragma once

#include "api/jobs/postgres_connection.h"

namespace slipway::api {

// Makes the tables in the schema that the connection finds first, where they are not there yet; otherwise
// checks that they are of this program's version. Several processes may do so at once. Throws PostgresFailure
// with what to do where they are of a newer program.
void settle_schema(PostgresConnection& connection);

}  // namespace slipway::api
