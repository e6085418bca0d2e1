#include "pbnbrdf/network/network_shape.h"

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

NetworkShape::NetworkShape(Encoding encoding, std::vector<int> hidden, Activation activation,
                           int outputs)
    : encoding_(encoding), activation_(activation), sizes_{kEncodedSize}, offsets_{0} {
  if (hidden.empty() || hidden.size() >= kMaxLayers) {
    Fail("hidden: ", hidden.size(), " layers; must be 1 to ", kMaxLayers - 1);
  }
  for (int size : hidden) {
    if (size < 1 || size > kMaxLayerSize) {
      Fail("hidden: a layer of ", size, " units; must be 1 to ", kMaxLayerSize);
    }
    sizes_.push_back(size);
  }
  if (outputs != 1 && outputs != kChannels) {
    Fail("channels: ", outputs, " outputs; must be 1 or ", kChannels);
  }
  sizes_.push_back(outputs);
  for (int layer = 0; layer < num_layers(); ++layer) {
    offsets_.push_back(offsets_.back() + block_size(layer));
  }
}

std::string NetworkShape::Description() const {
  std::string text;
  for (int size : sizes_) text += StrCat(text.empty() ? "" : "-", size);
  return StrCat(text, " ", NameOf(kActivations, activation_));
}

}  // namespace pbnbrdf
