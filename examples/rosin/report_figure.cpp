// SPDX-License-Identifier: MIT
#include "report_figure.hpp"

#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>

extern char** environ;  // NOLINT: POSIX

namespace tool {

namespace {

namespace fs = std::filesystem;

std::optional<std::string> program_on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders{path != nullptr ? path : ""};
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string place = (folder.empty() ? "." : folder) + "/" + name;
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored) && ::access(place.c_str(), X_OK) == 0) return place;
  }
  return std::nullopt;
}

/// A folder that is gone with its owner.
struct scratch_folder {
  std::string path;
  scratch_folder() {
    std::error_code error;
    std::string form = (fs::temp_directory_path(error) / "rosin-figures-XXXXXX").string();
    if (!error && ::mkdtemp(form.data()) != nullptr) path = form;
  }
  scratch_folder(const scratch_folder&) = delete;
  scratch_folder& operator=(const scratch_folder&) = delete;
  ~scratch_folder() {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
  }
};

/// In single quotes, where nothing has a meaning: in double ones a backquote begins a command of the shell.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : rosin::one_line(text)) out += c == '\'' ? std::string{"''"} : std::string{c};
  return out + "'";
}

/// The name of a tick is a form as printf's.
std::string tick_name(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '%' ? std::string{"%%"} : std::string{c};
  return in_quotes(out);
}

void write_data(std::ostream& out, const std::string& name, const curve& c) {
  out << name << " << EOD\n";
  bool gap = true;
  for (std::size_t i = 0; i < c.x.size() && i < c.y.size(); ++i) {
    const bool known = std::isfinite(c.x[i]) && std::isfinite(c.y[i]);
    if (known) out << c.x[i] << ' ' << c.y[i] << '\n';
    else if (!gap) out << '\n';
    gap = !known;
  }
  if (c.x.empty()) out << "NaN NaN\n";
  out << "EOD\n";
}

/// Cells in shades by the logarithm of their value, with the key beside them; `bottom`, `top`: of the plot, on the screen.
void plot_cells(std::ostream& out, const panel& p, const std::string& name, double bottom, double top, int width) {
  out << "$" << name << " << EOD\n";
  for (const auto& c : p.cells)
    out << c.from_x << ' ' << c.to_x << ' ' << c.from_y << ' ' << c.to_y << ' ' << std::log10(std::clamp(c.value, 1.0, 100.0))
        << '\n';
  out << "EOD\nset style fill solid 1 noborder\nset palette defined (0 '#f4f4f2', 0.5 '#f3d9a4', 1 '" << colour::far << "', 2 '"
      << colour::slip << "')\nset cbrange [0:2]\nset cbtics ('1' 0, '3' 0.477, '10' 1, '30' 1.477, '100' 2) nomirror\n"
      << "set colorbox user origin screen " << 1 - 58.0 / width << ", screen " << bottom << " size screen " << 12.0 / width
      << ", screen " << top - bottom << "\n"
      << "plot $" << name << " using (($1+$2)/2):(($3+$4)/2):1:2:3:4:5 with boxxyerror lc palette notitle\n";
}

void write_panel(std::ostream& out, const panel& p, const std::string& name, double bottom, double top, int width,
                 double height) {
  for (std::size_t c = 0; c < p.curves.size(); ++c) write_data(out, "$" + name + "_" + std::to_string(c), p.curves[c]);
  const auto range = [&](const char* axis, const std::optional<std::pair<double, double>>& r) {
    if (r) out << "set " << axis << "range [" << r->first << ":" << r->second << "]\n";
    else out << "set " << axis << "range [*:*]\n";
  };
  range("x", p.x_range);
  range("y", p.y_range);
  out << "unset arrow\n";
  for (const auto& [from, to] : p.heavy)
    out << "set arrow from first " << from << ", graph 0.955 to first " << to << ", graph 0.955 nohead lw 5 lc rgb '"
        << colour::slip << "'\n";
  out << "set label 1 " << in_quotes(p.title) << " at screen " << 82.0 / width << ", screen " << top + 14 / height
      << " left noenhanced\nset key at screen " << 1 - 18.0 / width << ", screen " << top + 22 / height << "\nset xlabel "
      << in_quotes(p.x_label) << " noenhanced\nset label 2 " << in_quotes(p.y_label) << " at screen " << 14.0 / width
      << ", screen " << (bottom + top) / 2 << " center rotate noenhanced\n"
      << "set lmargin at screen " << 82.0 / width << "\nset rmargin at screen " << 1 - (p.cells.empty() ? 18.0 : 70.0) / width
      << "\nset bmargin at screen " << bottom << "\nset tmargin at screen " << top << "\nset ytics autofreq\n";
  for (std::size_t i = 0; i < p.y_marks.size(); ++i)
    out << (i == 0 ? "set ytics (" : "set ytics add (") << tick_name(p.y_marks[i].second) << ' ' << p.y_marks[i].first << ")\n";
  if (!p.cells.empty()) return plot_cells(out, p, name, bottom, top, width);
  out << "plot ";
  for (std::size_t c = 0; c < p.curves.size(); ++c) {
    const curve& k = p.curves[c];
    out << (c > 0 ? ", " : "") << "$" << name << "_" << c << " using 1:2 with lines lw " << k.width << " dt " << k.dash
        << " lc rgb '" << k.colour << "' "
        << (k.name.empty() ? std::string{"notitle"} : "title " + in_quotes(k.name) + " noenhanced");
  }
  out << "\n";
}

void write_figure(std::ostream& out, const figure& f, std::size_t number) {
  constexpr double above = 34, numbers = 26, label = 56;  // around each panel: title; numbers; numbers with their label
  double height = 0;
  for (const auto& p : f.panels) height += p.height;
  out << "set terminal svg size " << f.width << "," << height
      << " dynamic enhanced font 'sans-serif,13' background 'white' name 'figure" << number << "'\nset multiplot\n";
  double from_top = 0;
  for (std::size_t i = 0; i < f.panels.size(); ++i) {
    const panel& p = f.panels[i];
    const double below = p.x_label.empty() ? numbers : label;
    write_panel(out, p, std::string{"d"}.append(std::to_string(number)).append("_").append(std::to_string(i)),
                1 - (from_top + p.height - below) / height, 1 - (from_top + above) / height, f.width, height);
    from_top += p.height;
  }
  out << "unset multiplot\nset output\n";
}

/// Ours without what would have gnuplot draw otherwise: its own variables and the locale.
std::vector<std::string> plain_environment() {
  std::vector<std::string> out{"LC_ALL=C"};
  for (char** line = environ; *line != nullptr; ++line) {
    const std::string_view text = *line;
    if (!text.starts_with("GNU") && !text.starts_with("LC_") && !text.starts_with("LANG") && !text.starts_with("FIT_"))
      out.emplace_back(text);
  }
  return out;
}

/// The script comes as standard input and the figures leave as standard output, so that no name of a file stands in it.
bool run_gnuplot(const std::string& program, const std::string& script, const std::string& drawn, const std::string& log) {
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, script.c_str(), O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, drawn.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::string name = "gnuplot", defaults = "-d", input = "-";  // -d: neither ~/.gnuplot nor the system's
  const std::array<char*, 4> arguments{name.data(), defaults.data(), input.data(), nullptr};
  std::vector<std::string> variables = plain_environment();
  std::vector<char*> environment;
  for (auto& v : variables) environment.push_back(v.data());
  environment.push_back(nullptr);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environment.data());
  ::posix_spawn_file_actions_destroy(&actions);
  int status = 1;
  return failed == 0 && ::waitpid(child, &status, 0) == child && status == 0;
}

std::string file_text(const std::string& path) {
  std::ifstream in{path, std::ios::binary};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

std::optional<rosin::failure> cannot_draw() {
  if (program_on_path("gnuplot")) return std::nullopt;
  return rosin::failure{
      "--report: gnuplot draws the figures, and it is not on the PATH (on Debian: apt-get install gnuplot-nox)"};
}

rosin::outcome<std::vector<std::string>> draw(const std::vector<figure>& figures) {
  const auto program = program_on_path("gnuplot");
  const scratch_folder folder;
  if (!program) return *cannot_draw();
  std::error_code error;
  if (folder.path.empty()) {
    const auto where = fs::temp_directory_path(error);
    return rosin::failure{"no temporary folder could be made" +
                          (error ? ": TMPDIR: " + error.message() : " in " + where.string())};
  }
  const std::string script = folder.path + "/figures.gp", drawn = folder.path + "/figures.svg", log = folder.path + "/log";
  errno = 0;
  {
    std::ofstream out{script};
    out.imbue(std::locale::classic());
    out.precision(9);
    out << "set encoding utf8\nset border 3 lc rgb '#444444'\nset tics nomirror textcolor rgb '#222222'\nset grid lc rgb "
           "'#e4e4e4' lw 0.8 lt 1\n"
           "set key right horizontal samplen 2.4 font ',12' maxrows 1\n"
           "set datafile missing 'NaN'\n";
    for (std::size_t i = 0; i < figures.size(); ++i) write_figure(out, figures[i], i + 1);
    out.flush();
    if (!out) return rosin::failure{script + ": cannot be written" + rosin::detail::system_reason()};
  }
  const bool ran = run_gnuplot(*program, script, drawn, log);
  const std::string all = file_text(drawn), said = file_text(log);
  if (!ran) return rosin::failure{"gnuplot failed: " + said};
  std::vector<std::string> svg;
  for (std::size_t from = all.find("<svg"); from != std::string::npos; from = all.find("<svg", from)) {
    const std::size_t end = all.find("</svg>", from);
    if (end == std::string::npos) break;
    svg.push_back(all.substr(from, end + 6 - from));
    from = end;
  }
  if (svg.size() != figures.size())
    return rosin::failure{"gnuplot drew " + std::to_string(svg.size()) + " of " + std::to_string(figures.size()) +
                          " figures: " + said};
  return svg;
}

}  // namespace tool
