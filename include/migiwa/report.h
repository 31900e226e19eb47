// What a run did, in numbers.
//
//   makeReport, reportText, readReport; SettledMeasures.
#pragma once

#include "core/io/report.h"
#include "core/simulation/measures.h"
