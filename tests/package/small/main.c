#include <stdio.h>
#include "commit.h"
int main(void) { puts("first"); return LATCON_GIT_COMMIT[0] == 0; }
