"""G54 to G59: the table and its history."""
