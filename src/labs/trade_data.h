// labs/trade_data.h  2  what `make trade` has measured: errors, times, laws, answers
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "film/image.h"

// One sample count of one setting.  The error is
// d_rel (Khodulev 1996, ch. 5), bias included where the setting is biased, NAN if it is smaller
// than what the reference shows; seconds are of one core, for an image of the size that the file
// gives.
struct TradePoint {
    double spp = 0, seconds = 0, error = 0, error_se = 0;
};

// Words after `penumbra` and the scene.
struct TradeSetting {
    std::string words;
    bool is_float = false, unbiased = true, takes_every_scene = true;
    std::vector<TradePoint> points = {};
    // error = c seconds^-gamma, and the deviation of the logarithms of the points' errors from it.
    double c = NAN, gamma = NAN, spread = NAN;
    std::string dropped = "";  // after which count and why; "": measured to the end
};

// An image by a setting in about as many seconds as the scene's other pictures.
struct TradePicture {
    std::string words;
    bool is_float = false;
    double seconds = 0, error = 0;
    Image image = {};
};

// The cheapest setting whose error is E; NAN seconds: the laws do not reach so far.
struct TradeAnswer {
    double E = 0;
    size_t setting = SIZE_MAX;  // of the scene's settings
    double seconds = NAN, default_seconds = NAN;
};

struct TradeScene {
    std::string name, remark = "";
    int width = 0, height = 0;  // of its image
    double exposure = 1;        // of the scene's file
    std::vector<TradeSetting> settings = {};
    std::vector<TradeAnswer> answers = {};
    Image reference = {};
    double reference_error = NAN;  // its own d_rel
    std::vector<TradePicture> pictures = {};
};

// A setting that may be the default: unbiased, and it takes every scene.  Its seconds over those of
// the cheapest such setting at equal error.
struct TradeCandidate {
    std::string words;
    bool is_float = false;
    double mean_ratio = NAN, worst_ratio = NAN;  // geometric mean; greatest
    std::string worst_scene = "";
};

struct Trade {
    std::vector<TradeScene> scenes = {};
    std::vector<TradeCandidate> candidates = {};  // the best first
    std::string default_words = "";               // of the program today
    std::string command = "";                     // that measured this
};
