// Labelled images of both formats, and what is said of those that are none.
#include "sinew/io/image.h"

#include <gtest/gtest.h>

#include <cstring>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "tests/support/errors.h"
#include "tests/support/source_dir.h"

namespace sinew::io {
namespace {

std::string image_seed(const std::string& name) {
  return test::source_path("fuzz/corpus/image/" + name);
}

Vec3 place(const LabelImage& image, double i, double j, double k) {
  return image.origin + image.axes * Vec3(i, j, k);
}

template <typename Parse>
std::string image_error(Parse parse, std::string_view bytes) {
  return test::message_of([&] { parse(bytes, "i"); });
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

// The same in the header of an INR file, whose length stays.
std::string with_header(std::string text, const std::string& from, const std::string& to) {
  text = with(std::move(text), from, to);
  const std::size_t end = text.find("##}");
  if (to.size() > from.size()) {
    text.erase(end - (to.size() - from.size()), to.size() - from.size());
  } else {
    text.insert(end, from.size() - to.size(), '\n');
  }
  return text;
}

template <typename T>
std::string put(std::string bytes, std::size_t place, T value) {
  std::memcpy(bytes.data() + place, &value, sizeof(T));
  return bytes;
}

TEST(Image, TheSameVoxelsInEveryForm) {
  for (const char* name :
       {"plain.inr", "plain.inr.gz", "plain.nii", "plain.nii.gz", "turned.nii", "big-endian.inr"}) {
    SCOPED_TRACE(name);
    const LabelImage image = read_image(image_seed(name));
    EXPECT_EQ(image.size, (std::array<Index, 3>{4, 3, 2}));
    EXPECT_EQ(image.labels, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(image.voxels[image.index(0, 0, 1)], 1);
    EXPECT_EQ(image.voxels[image.index(1, 0, 1)], 2);
    EXPECT_EQ(image.voxels[image.index(1, 1, 1)], 1);
    EXPECT_EQ(image.voxels[image.index(2, 2, 0)], 0);
  }
}

TEST(Image, VoxelsLieWhereTheHeaderSays) {
  EXPECT_EQ(place(read_image(image_seed("plain.nii")), 1, 2, 1), Vec3(1, 3, 2));
  EXPECT_EQ(place(read_image(image_seed("big-endian.inr")), 1, 2, 1), Vec3(6, 3, 2));
  // A matrix that mirrors, and swaps axes.
  EXPECT_EQ(place(read_image(image_seed("turned.nii")), 1, 2, 1), Vec3(4, 8, 10));
  // A quaternion: a quarter turn about z.
  const LabelImage floats = read_image(image_seed("floats.nii"));
  EXPECT_LT((place(floats, 1, 2, 1) - Vec3(-13, -19, -28)).norm(), 1e-5);
  EXPECT_EQ(floats.labels, (std::vector<int>{0, 3, 6}));  // a slope of 3
}

TEST(Image, MistakesOfInrAreNamed) {
  const std::string good = read_file(image_seed("plain.inr"));
  EXPECT_EQ(image_error(parse_inr, "hello"),
            "is not an INR file: it does not begin with \"#INRIMAGE-4#{\"");
  EXPECT_EQ(image_error(parse_inr, good.substr(0, 100)),
            "its header does not end: no line \"##}\"");
  EXPECT_EQ(image_error(parse_inr, good.substr(0, 270)), "promises 280 bytes and has 270");
  EXPECT_EQ(image_error(parse_inr, with(good, "XDIM=4", "XDIM=0")),
            "has 0 x 3 x 2 voxels; 1 to 2^31 were expected");
  EXPECT_EQ(image_error(parse_inr, with_header(good, "XDIM=4\nYDIM=3", "XDIM=40000\nYDIM=20000")),
            "promises 1600000256 bytes and has 280");
  EXPECT_EQ(image_error(parse_inr, with(good, "VDIM=1", "VDIM=3")),
            "has 3 values a voxel; one label was expected");
  EXPECT_EQ(image_error(parse_inr, with(good, "VX=1", "VX=0")),
            "the distance between voxels along axis 0 is 0");
  EXPECT_EQ(image_error(parse_inr, with(good, "VX=1", "VX=a")),
            "VX is \"a\"; a number was expected");
  EXPECT_EQ(image_error(parse_inr, with_header(good, "unsigned fixed", "complex")).substr(0, 28),
            "its voxels are \"complex\" of ");
  EXPECT_EQ(image_error(parse_inr, with(good, "CPU=decm", "CPU=z80x")),
            "CPU is \"z80x\"; decm, alpha, pc, sun or sgi was expected");
}

TEST(Image, MistakesOfNiftiAreNamed) {
  const std::string good = read_file(image_seed("plain.nii"));
  EXPECT_EQ(image_error(parse_nifti, "hello"),
            "is not a NIfTI-1 file: its header of 348 bytes is missing");
  EXPECT_EQ(image_error(parse_nifti, put(good, 0, 540)), "is a NIfTI-2 file");
  EXPECT_EQ(image_error(parse_nifti, with(good, "n+1", "ni1")),
            "is not NIfTI-1 in one file: its header ends without \"n+1\"");
  EXPECT_EQ(image_error(parse_nifti, good.substr(0, 370)), "promises 376 bytes and has 370");
  EXPECT_EQ(image_error(parse_nifti, put<std::int16_t>(good, 42, -4)),
            "has -4 x 3 x 2 voxels; 1 to 2^31 were expected");
  EXPECT_EQ(image_error(parse_nifti, put<std::int16_t>(put<std::int16_t>(good, 40, 4), 48, 7)),
            "has 4 dimensions; one volume with 3 was expected");
  EXPECT_EQ(image_error(parse_nifti, put<std::int16_t>(good, 70, 32)),
            "its voxels have NIfTI's data type 32; numbers of 8 to 64 bits can be read");
  EXPECT_EQ(image_error(parse_nifti, put(good, 112, 0.3F)).substr(0, 10), "voxel 12 i");
  const std::string turned = read_file(image_seed("turned.nii"));
  EXPECT_EQ(image_error(parse_nifti, put(turned, 284, 0.5F)),
            "its axes are not at right angles to each other");
}

TEST(Image, AScanIsToldFromLabels) {
  std::string scan = with_header(read_file(image_seed("plain.inr")), "XDIM=4\n", "XDIM=40\n");
  scan = with_header(scan, "PIXSIZE=8 bits", "PIXSIZE=16 bits");
  scan.resize(256);
  for (int i = 0; i < 240; ++i) {
    scan += static_cast<char>(i);
    scan += static_cast<char>(i % 7);
  }
  EXPECT_EQ(image_error(parse_inr, scan), "no error");  // 240 labels are possible
  scan = with_header(scan, "ZDIM=2", "ZDIM=3");
  for (int i = 0; i < 120; ++i) scan += {static_cast<char>(i), '\x09'};
  EXPECT_EQ(image_error(parse_inr, scan), "has more than 255 different values");
}

TEST(Image, DamagedCompressionIsNamed) {
  std::string bytes = read_file(image_seed("plain.nii.gz"));
  for (std::size_t i = 12; i < 40; ++i) bytes[i] = static_cast<char>(0xa5);
  EXPECT_EQ(image_error(parse_nifti, bytes).substr(0, 19), "cannot be expanded:");
  const std::string good = read_file(image_seed("plain.nii.gz"));
  EXPECT_EQ(image_error(parse_nifti, good.substr(0, 40)).substr(0, 6), "is not");
}

TEST(Image, EndingsAreKnown) {
  EXPECT_TRUE(is_image_name("a.NII.gz"));
  EXPECT_TRUE(is_image_name("a.inr"));
  EXPECT_FALSE(is_image_name("a.gz"));
  EXPECT_FALSE(is_image_name("nii"));
}

}  // namespace
}  // namespace sinew::io
