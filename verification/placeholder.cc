namespace verification { int placeholder() { return 0; } }
