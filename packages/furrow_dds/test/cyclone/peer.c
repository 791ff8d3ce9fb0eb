/* A Cyclone DDS program for tests. It runs until its standard input ends.
 * - It answers an image on rt/camera/image with odometry on rt/cyclone/answer. Height, width and the
 *   sum of the bytes are the position.
 * - It answers odometry on rt/localization/odometry with doubled position and speed.
 * - It also answers odometry with an image of one pixel and the same frame, on rt/cyclone/image.
 *   That writer offers best effort, as a camera driver does.
 *
 * usage: cyclone_peer DOMAIN */
#include <dds/dds.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "ros_types.h"

typedef sensor_msgs_msg_dds__Image_ Image;
typedef nav_msgs_msg_dds__Odometry_ Odometry;

enum { kBatch = 8, kLookMs = 5 };

static dds_entity_t check(dds_entity_t entity) {
  if (entity < 0) {
    fprintf(stderr, "cyclone_peer: %s\n", dds_strretcode(-entity));
    exit(1);
  }
  return entity;
}

static void answer(dds_entity_t writer, const char* frame, double x, double y, double z,
                   double speed) {
  Odometry message = {0};
  message.header.frame_id = (char*)frame;
  message.child_frame_id = "cyclone";
  message.pose.pose.position.x = x;
  message.pose.pose.position.y = y;
  message.pose.pose.position.z = z;
  message.pose.pose.orientation.w = 1.0;
  message.twist.twist.linear.x = speed;
  message.twist.covariance[35] = 0.25;
  if (dds_write(writer, &message) < 0) fprintf(stderr, "cyclone_peer: not written\n");
}

static void look_at_image(dds_entity_t writer, const Image* image) {
  double sum = 0.0;
  for (uint32_t i = 0; i < image->data._length; ++i) sum += image->data._buffer[i];
  answer(writer, image->header.frame_id, image->height, image->width, sum, 0.0);
}

static void look_at_odometry(dds_entity_t writer, dds_entity_t camera, const Odometry* odometry) {
  uint8_t pixel = 7;
  Image image = {0};
  image.header.frame_id = odometry->header.frame_id;
  image.height = image.width = image.step = 1;
  image.encoding = "mono8";
  image.data._buffer = &pixel;
  image.data._length = image.data._maximum = 1;
  if (dds_write(camera, &image) < 0) fprintf(stderr, "cyclone_peer: not written\n");
  answer(writer, odometry->header.frame_id, 2.0 * odometry->pose.pose.position.x,
         2.0 * odometry->pose.pose.position.y, 2.0 * odometry->pose.pose.position.z,
         2.0 * odometry->twist.twist.linear.x);
}

int main(int argc, char** argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: cyclone_peer DOMAIN\n");
    return 2;
  }
  const dds_entity_t participant =
      check(dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL));
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  const dds_entity_t images = check(dds_create_topic(participant, &sensor_msgs_msg_dds__Image__desc,
                                                     "rt/camera/image", NULL, NULL));
  const dds_entity_t odometry = check(dds_create_topic(
      participant, &nav_msgs_msg_dds__Odometry__desc, "rt/localization/odometry", NULL, NULL));
  const dds_entity_t answers = check(dds_create_topic(
      participant, &nav_msgs_msg_dds__Odometry__desc, "rt/cyclone/answer", NULL, NULL));
  const dds_entity_t image_reader = check(dds_create_reader(participant, images, qos, NULL));
  const dds_entity_t odometry_reader = check(dds_create_reader(participant, odometry, qos, NULL));
  const dds_entity_t writer = check(dds_create_writer(participant, answers, qos, NULL));
  const dds_entity_t camera_topic = check(dds_create_topic(
      participant, &sensor_msgs_msg_dds__Image__desc, "rt/cyclone/image", NULL, NULL));
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  const dds_entity_t camera = check(dds_create_writer(participant, camera_topic, qos, NULL));
  dds_delete_qos(qos);

  struct pollfd input = {STDIN_FILENO, POLLIN, 0};
  while (poll(&input, 1, kLookMs) == 0) {
    void* samples[kBatch] = {NULL};
    dds_sample_info_t infos[kBatch];
    int count = dds_take(image_reader, samples, infos, kBatch, kBatch);
    for (int i = 0; i < count; ++i) {
      if (infos[i].valid_data) look_at_image(writer, samples[i]);
    }
    if (count > 0) dds_return_loan(image_reader, samples, count);
    samples[0] = NULL;
    count = dds_take(odometry_reader, samples, infos, kBatch, kBatch);
    for (int i = 0; i < count; ++i) {
      if (infos[i].valid_data) look_at_odometry(writer, camera, samples[i]);
    }
    if (count > 0) dds_return_loan(odometry_reader, samples, count);
  }
  dds_delete(participant);
  return 0;
}
