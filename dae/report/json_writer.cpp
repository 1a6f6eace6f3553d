#include <momenta/dae/report/json_writer.h>

#include <momenta/dae/report/json.h>

namespace momenta {
namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

}  // namespace

JsonWriter::JsonWriter() : out_("{") {}

void JsonWriter::line() {
  out_ += '\n';
  out_.append(2 * depth_, ' ');
}

void JsonWriter::start(const std::string& key) {
  if (!first_) out_ += ',';
  first_ = false;
  line();
  out_ += quoted(key) + ": ";
}

void JsonWriter::open(const std::string& key) {
  start(key);
  out_ += '{';
  ++depth_;
  first_ = true;
}

void JsonWriter::close() {
  --depth_;
  if (!first_) line();
  out_ += '}';
  first_ = false;
}

void JsonWriter::text(const std::string& key, const std::string& value) {
  start(key);
  out_ += quoted(value);
}

void JsonWriter::texts(const std::string& key, const std::vector<std::string>& values) {
  start(key);
  out_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) out_ += (i > 0 ? ", " : "") + quoted(values[i]);
  out_ += ']';
}

void JsonWriter::whole_number(const std::string& key, int value) {
  start(key);
  out_ += std::to_string(value);
}

void JsonWriter::number(const std::string& key, double value) {
  start(key);
  put(value);
}

void JsonWriter::put(double value) {
  out_ += number_or_null(value).dump();
}

std::string JsonWriter::take() {
  close();
  return std::move(out_) + "\n";
}

}  // namespace momenta
