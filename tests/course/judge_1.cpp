// course/judge_1.cpp  judges week 1: intersections and the tree
#include "course/judge_1_shapes.h"
#include "course/judge_1_tree.h"

using namespace penumbra;
using namespace course;

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"1.1", camera},
                          {"1.2", sphere},
                          {"1.3", triangle},
                          {"1.4", box},
                          {"1.5", tree},
                          {"1.6", division}});
}
