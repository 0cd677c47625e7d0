namespace lattice { int placeholder() { return 0; } }
