#include "support/pvd.h"

#include <gtest/gtest.h>

namespace pvd_test
{

using namespace latcon::support;

TEST(Pvd, NamesFilesWithTimesInFullPrecision)
{
  EXPECT_EQ(pvd_text({{0.1, "a.vtp"}, {1. / 3., "b.vtp", 1}}),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0.1\" part=\"0\" file=\"a.vtp\"/>\n"
            "    <DataSet timestep=\"0.3333333333333333\" part=\"1\" file=\"b.vtp\"/>\n"
            "  </Collection>\n"
            "</VTKFile>\n");
}

} // namespace pvd_test
