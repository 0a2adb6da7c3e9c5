// Brackets the suite in CTest: `stability_table clear FOLDER` before its runs, `stability_table make FOLDER`
// after them, which prints the table and writes it as stability.csv and stability.md.
#include <fstream>
#include <iostream>
#include <string_view>

#include "table.h"

int main(int count, char** arguments) {
  using namespace weft::stability;
  const std::string_view what = count == 3 ? arguments[1] : "";
  if (what != "clear" && what != "make") {
    std::cerr << "stability_table clear|make FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = arguments[2], rows = folder / "rows";
  if (what == "clear") {
    std::filesystem::remove_all(rows);
    return 0;
  }
  const std::vector<Row> table = kept(rows);
  if (table.empty()) {
    std::cerr << "no run has left a row in " << rows << '\n';
    return 1;
  }
  std::ofstream(folder / "stability.csv") << csv(table);
  std::ofstream(folder / "stability.md") << markdown(table);
  std::cout << markdown(table);
}
