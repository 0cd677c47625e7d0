namespace continuum { int placeholder() { return 0; } }
