// The whole render graph in one include.
#pragma once

#include "alcove/framegraph/access.h"
#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/graph.h"
#include "alcove/framegraph/print.h"
