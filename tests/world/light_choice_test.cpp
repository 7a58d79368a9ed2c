// world/light_choice_test.cpp  the choice of one light for a sample, which looks at all lights
#include "world/light_cases.h"

TEST_CASE_TEMPLATE_INVOKE(one_of_many, LightList);
TEST_CASE_TEMPLATE_INVOKE(one_light, LightList);
TEST_CASE_TEMPLATE_INVOKE(only_where_nothing, LightList);
TEST_CASE_TEMPLATE_INVOKE(far_away, LightList);
TEST_CASE_TEMPLATE_INVOKE(most_by_most, LightList);
TEST_CASE_TEMPLATE_INVOKE(up_to_one, LightList);
TEST_CASE_TEMPLATE_INVOKE(faint_weights, LightList);

TEST_CASE("the sphere about a polygon holds its corners, and touches two of a quad's") {
    Dice dice;
    for (size_t i = 0; i < 2000; ++i) {
        const Light l = light_of(dice, 2 + i % 2, 1);
        real most = 0;
        for (vec3 corner : corners_of(l)) most = std::max(most, length(corner - l.centre));
        CHECK(std::abs(most - l.radius) < 16 * ulp);
    }
}
