#include "core/simulation/state_image.h"

#include "core/simulation/simulation.h"
#include "core/simulation/state_visitor.h"

namespace migiwa {

class StateImage::Writer final : public StateVisitor {
 public:
  explicit Writer(StateImage& image) : image_(image) {}

  bool reading() const override { return false; }
  void number(std::string_view name, double& value) override { image_.numbers_[std::string(name)] = value; }
  void integer(std::string_view name, std::int64_t& value) override {
    image_.integers_[std::string(name)] = value;
  }
  void text(std::string_view name, std::string& value) override { image_.texts_[std::string(name)] = value; }

 protected:
  void store(std::string_view name, std::size_t, std::span<const std::byte> bytes) override {
    image_.arrays_[std::string(name)].assign(bytes.begin(), bytes.end());
  }
  std::span<const std::byte> load(std::string_view, std::size_t) override { return {}; }

 private:
  StateImage& image_;
};

class StateImage::Reader final : public StateVisitor {
 public:
  explicit Reader(const StateImage& image) : image_(image) {}

  bool reading() const override { return true; }
  void number(std::string_view name, double& value) override { value = find(image_.numbers_, name); }
  void integer(std::string_view name, std::int64_t& value) override { value = find(image_.integers_, name); }
  void text(std::string_view name, std::string& value) override { value = find(image_.texts_, name); }

 protected:
  void store(std::string_view, std::size_t, std::span<const std::byte>) override {}
  std::span<const std::byte> load(std::string_view name, std::size_t) override {
    return find(image_.arrays_, name);
  }

 private:
  template <class Map>
  static const typename Map::mapped_type& find(const Map& map, std::string_view name) {
    const auto found = map.find(name);
    if (found == map.end()) throw StateError("\"" + std::string(name) + "\", found another scene's state");
    return found->second;
  }

  const StateImage& image_;
};

StateImage StateImage::of(Simulation& simulation) {
  StateImage image;
  Writer writer(image);
  simulation.visitState(writer);
  return image;
}

void StateImage::restore(Simulation& simulation) const {
  Reader reader(*this);
  simulation.visitState(reader);
}

}  // namespace migiwa
